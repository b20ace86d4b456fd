"""Sine, cosine, exponential, logarithm and arctangent as plain arithmetic.

`math.sin` and its likes are library calls, which lanes make one body at a time, and whose last bits differ between
libraries. These have the same bits for one body, in lanes, and on every machine, and in lanes they are vector
instructions. Their coefficients are those of Sun's fdlibm and of Moshier's Cephes.
"""

from __future__ import annotations

import math

from dq_marine.algebra.selection import by_precision, exponent_of, power_of_two, rounded, select

TWO_OVER_PI = 2.0 / math.pi

QUARTER_TURN = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
"""pi/2 in parts of 33 bits, so that their products with a count of quarter turns below 2^20 are exact."""

QUARTER_TURN_SINGLE = (1.5703125, 4.8375129699707031e-4, 7.54978994964e-8)
"""The same in parts of 8 to 11 bits, for single precision."""

SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
"""Minimax coefficients of (sin x - x)/x^3 and (cos x - 1 + x^2/2)/x^4 on |x| <= pi/4: those of Sun's fdlibm."""

EXPONENT = (
    1.66666666666666019037e-01,
    -2.77777777770155933842e-03,
    6.61375632143793436117e-05,
    -1.65339022054652515390e-06,
    4.13813679705723846039e-08,
)
"""Minimax coefficients of x coth(x/2) - 2 over x^2 on |x| <= ln(2)/2: fdlibm's."""

LOG2_E = 1.4426950408889634
"""log2(e), as a number: a library's own logarithm may differ in the last bit."""

LOG_2, LOG_2_SINGLE = (6.93147180369123816490e-01, 1.90821492927058770002e-10), (0.693359375, -2.12194440e-4)
"""ln 2 in two parts, of which the first has so few digits that its products with whole numbers are exact."""

EXPONENTS, EXPONENTS_SINGLE = (-708.0, 709.0), (-87.0, 88.0)
"""Within which e^x is a normal number."""

LOGARITHM = (
    6.666666666666735130e-01,
    3.999999999940941908e-01,
    2.857142874366239149e-01,
    2.222219843214978396e-01,
    1.818357216161805012e-01,
    1.531383769920937332e-01,
    1.479819860511658591e-01,
)
"""Minimax coefficients of (log((1 + s)/(1 - s)) - 2 s)/s^3 on |s| <= 0.1716: fdlibm's."""

ABOVE = (
    -8.750608600031904122785e-01,
    -1.615753718733365076637e01,
    -7.500855792314704667340e01,
    -1.228866684490136173410e02,
    -6.485021904942025371773e01,
)
BELOW = (
    2.485846490142306297962e01,
    1.650270098316988542046e02,
    4.328810604912902668951e02,
    4.853903996359136964868e02,
    1.945506571482613964425e02,
)
"""Coefficients of (atan x - x)/x^3, a fraction in x^2, on |x| <= 0.66: Cephes'."""

SMALL, LARGE = 0.41421356237309503, 2.414213562373095
"""tan(pi/8) and tan(3 pi/8)."""


def polynomial6(c: tuple[float, float, float, float, float, float], x: float) -> float:
    """Return c_0 + c_1 x + ... + c_5 x^5."""
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))))


def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Return the sine and cosine of an angle [rad] of up to 1e6, to about 2e-16; beyond that the error grows."""
    quarters = rounded(angle * TWO_OVER_PI)
    first = by_precision(angle, QUARTER_TURN[0], QUARTER_TURN_SINGLE[0])
    second = by_precision(angle, QUARTER_TURN[1], QUARTER_TURN_SINGLE[1])
    third = by_precision(angle, QUARTER_TURN[2], QUARTER_TURN_SINGLE[2])
    x = ((angle - quarters * first) - quarters * second) - quarters * third
    square = x * x
    sine = x + x * square * polynomial6(SINE, square)
    cosine = 1.0 - (0.5 * square - square * square * polynomial6(COSINE, square))
    quadrant = quarters - 4.0 * rounded(0.25 * quarters)  # -2, -1, 0, 1 or 2
    odd = abs(quadrant) == 1.0
    opposite = abs(quadrant) == 2.0
    s, c = select(odd, cosine, sine), select(odd, sine, cosine)
    return (
        select(opposite | (quadrant == -1.0), -s, s),
        select(opposite | (quadrant == 1.0), -c, c),
    )


def exponential(x: float) -> float:
    """Return e^x to the last digit but one; x is held within -708 and 709, in single precision within -87 and 88.

    e^x = 2^k e^r with |r| <= ln(2)/2, and e^r = 1 + r + r c/(2 - c), c = r - r^2 P(r^2) (fdlibm, e_exp.c).
    """
    lowest = by_precision(x, EXPONENTS[0], EXPONENTS_SINGLE[0])
    highest = by_precision(x, EXPONENTS[1], EXPONENTS_SINGLE[1])
    within = select(x < lowest, lowest, select(x > highest, highest, x))
    k = rounded(within * LOG2_E)
    high = within - k * by_precision(x, LOG_2[0], LOG_2_SINGLE[0])
    low = k * by_precision(x, LOG_2[1], LOG_2_SINGLE[1])
    r = high - low
    square = r * r
    tail = EXPONENT[2] + square * (EXPONENT[3] + square * EXPONENT[4])
    c = r - square * (EXPONENT[0] + square * (EXPONENT[1] + square * tail))
    return (1.0 - ((low - r * c / (2.0 - c)) - high)) * power_of_two(k)


def logarithm(x: float) -> float:
    """Return the natural logarithm of a positive normal number.

    x = 2^k (1 + f) with 1 + f between sqrt(1/2) and sqrt(2), and log(1 + f) = f - f^2/2 + s (f^2/2 + R(s^2)), with
    s = f/(2 + f) (fdlibm, e_log.c).
    """
    k = exponent_of(x)
    mantissa = 0.5 * (x * power_of_two(1.0 - k))  # 2^(1 - k) is a normal number for every x
    large = mantissa > math.sqrt(2.0)
    k = select(large, k + 1.0, k)
    f = select(large, 0.5 * mantissa, mantissa) - 1.0
    s, half = f / (2.0 + f), 0.5 * f * f
    z = s * s
    r = z * (LOGARITHM[0] + z * polynomial6(LOGARITHM[1:], z))
    high = k * by_precision(x, LOG_2[0], LOG_2_SINGLE[0])
    low = k * by_precision(x, LOG_2[1], LOG_2_SINGLE[1])
    return high - ((half - (s * (half + r) + low)) - f)


def arctangent(y: float, x: float) -> float:
    """Return the angle [rad], above -pi and up to pi, of the vector (x, y) of finite length; 0 for that of length 0.

    Angles within a quadrant beyond a sixteenth of a turn are reduced by an eighth, those beyond three sixteenths by a
    quarter; the fraction approximates what is left (Cephes, atan.c).
    """
    across, along = abs(y), abs(x)
    steep = across > LARGE * along
    oblique = across > SMALL * along
    above = select(steep, -along, select(oblique, across - along, across))
    below = select(steep, across, select(oblique, across + along, along))
    ratio = above / select(below == 0.0, 1.0, below)
    taken = select(steep, 0.5 * math.pi, select(oblique, 0.25 * math.pi, 0.0))
    z = ratio * ratio
    numerator = (((ABOVE[0] * z + ABOVE[1]) * z + ABOVE[2]) * z + ABOVE[3]) * z + ABOVE[4]
    denominator = ((((z + BELOW[0]) * z + BELOW[1]) * z + BELOW[2]) * z + BELOW[3]) * z + BELOW[4]
    angle = taken + (ratio + ratio * z * numerator / denominator)
    turned = select(x < 0.0, math.pi - angle, angle)
    return select(y < 0.0, -turned, turned)
