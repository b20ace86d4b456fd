"""Dormand and Prince's explicit Runge-Kutta method of order 8 (E1), with twelve stages, of which eight have a weight.

sum_i e_i k_i is the difference from a method of order 5 that the same stages hold. The coefficients are those of the
code DOP853 (Hairer, Norsett, Wanner 1993, Solving Ordinary Differential Equations I, sec. II.5 and II.10), each row
without its zeros: from the sixth stage on, stages 2 and 3 have none.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.stages import Weights, weighted_step, weighted_sum
from dq_marine.integrator.explicit import Explicit, Extent, Find, Foresee, IsStable, Taken, TakeStep

NODES: Weights = (
    0.0,
    0.0526001519587677318785587544488,
    0.0789002279381515978178381316732,
    0.118350341907227396726757197510,
    0.281649658092772603273242802490,
    0.333333333333333333333333333333,
    0.25,
    0.307692307692307692307692307692,
    0.651282051282051282051282051282,
    0.6,
    0.857142857142857142857142857142,
    1.0,
)
"""c_i."""

A2: Weights = (0.0526001519587677318785587544488,)
A3: Weights = (0.0197250569845378994544595329183, 0.0591751709536136983633785987549)
A4: Weights = (0.0295875854768068491816892993775, 0.0887627564304205475450678981324)
A5: Weights = (
    0.241365134159266685502369798665,
    -0.884549479328286085344864962717,
    0.924834003261792003115737966543,
)
A6: Weights = (
    0.037037037037037037037037037037,
    0.170828608729473871279604482173,
    0.125467687566822425016691814123,
)
A7: Weights = (0.037109375, 0.170252211019544039314978060272, 0.0602165389804559606850219397283, -0.017578125)
A8: Weights = (
    0.0370920001185047927108779319836,
    0.170383925712239993810214054705,
    0.107262030446373284651809199168,
    -0.0153194377486244017527936158236,
    0.00827378916381402288758473766002,
)
A9: Weights = (
    0.624110958716075717114429577812,
    -3.36089262944694129406857109825,
    -0.868219346841726006818189891453,
    27.5920996994467083049415600797,
    20.1540675504778934086186788979,
    -43.4898841810699588477366255144,
)
A10: Weights = (
    0.477662536438264365890433908527,
    -2.48811461997166764192642586468,
    -0.590290826836842996371446475743,
    21.2300514481811942347288949897,
    15.2792336328824235832596922938,
    -33.2882109689848629194453265587,
    -0.0203312017085086261358222928593,
)
A11: Weights = (
    -0.93714243008598732571704021658,
    5.18637242884406370830023853209,
    1.09143734899672957818500254654,
    -8.14978701074692612513997267357,
    -18.5200656599969598641566180701,
    22.7394870993505042818970056734,
    2.49360555267965238987089396762,
    -3.0467644718982195003823669022,
)
A12: Weights = (
    2.27331014751653820792359768449,
    -10.5344954667372501984066689879,
    -2.00087205822486249909675718444,
    -17.9589318631187989172765950534,
    27.9488845294199600508499808837,
    -2.85899827713502369474065508674,
    -8.87285693353062954433549289258,
    12.3605671757943030647266201528,
    0.643392746015763530355970484046,
)

WEIGHTS: Weights = (
    0.0542937341165687622380535766363,
    4.45031289275240888144113950566,
    1.89151789931450038304281599044,
    -5.8012039600105847814672114227,
    0.31116436695781989440891606237,
    -0.152160949662516078556178806805,
    0.201365400804030348374776537501,
    0.0447106157277725905176885569043,
)
"""b_i of stages 1 and 6 to 12."""

ERROR: Weights = (
    0.01312004499419488073250102996,
    -1.225156446376204440720569753,
    -0.4957589496572501915214079952,
    1.664377182454986536961530415,
    -0.350328848749973681688648729,
    0.3341791187130174790297318841,
    0.08192320648511571246570742613,
    -0.02235530786388629525884427845,
)
"""e_i of the same stages."""


class Telling(NamedTuple):
    """The difference from the method of order 5, and the rates at the start of the step and after a third of it."""

    difference: Any
    first: Any
    sixth: Any


LARGEST_DIFFERENCE = 0.0877
"""Of rates. For y' = z y that is reached at z = -6.39, where stability ends, and at z = 5.1i, where that ends at 6.0i;
wherever it is not exceeded the method is stable, unless the real part of z is positive."""


def make_step(foresee: Foresee, find: Find) -> TakeStep:
    """Return (E1): a step."""

    def step(context: Any, h: float, start: Any) -> Taken:
        s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12 = foresee(context, NODES)
        k1 = find(context, s1, start)
        k2 = find(context, s2, weighted_step(start, h, A2, (k1,)))
        k3 = find(context, s3, weighted_step(start, h, A3, (k1, k2)))
        k4 = find(context, s4, weighted_step(start, h, A4, (k1, k3)))
        k5 = find(context, s5, weighted_step(start, h, A5, (k1, k3, k4)))
        k6 = find(context, s6, weighted_step(start, h, A6, (k1, k4, k5)))
        k7 = find(context, s7, weighted_step(start, h, A7, (k1, k4, k5, k6)))
        k8 = find(context, s8, weighted_step(start, h, A8, (k1, k4, k5, k6, k7)))
        k9 = find(context, s9, weighted_step(start, h, A9, (k1, k4, k5, k6, k7, k8)))
        k10 = find(context, s10, weighted_step(start, h, A10, (k1, k4, k5, k6, k7, k8, k9)))
        k11 = find(context, s11, weighted_step(start, h, A11, (k1, k4, k5, k6, k7, k8, k9, k10)))
        k12 = find(context, s12, weighted_step(start, h, A12, (k1, k4, k5, k6, k7, k8, k9, k10, k11)))
        with_weights = (k1, k6, k7, k8, k9, k10, k11, k12)
        telling = Telling(weighted_sum(ERROR, with_weights), k1, k6)
        return Taken(weighted_step(start, h, WEIGHTS, with_weights), telling)

    return step


def make_is_stable(extent: Extent) -> IsStable:
    """Return whether a step was short enough."""

    def is_stable(context: Any, rates: Telling, blur: float) -> bool:
        changing = extent(context, rates.first) + extent(context, rates.sixth)
        return extent(context, rates.difference) <= LARGEST_DIFFERENCE**2 * changing + blur

    return is_stable


DORMAND_PRINCE = Explicit(8, make_step, make_is_stable)
