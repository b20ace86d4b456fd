"""Explicit Runge-Kutta methods of order 8 (E1) with twelve stages, of which eight have a weight.

From the sixth stage on, stages 2 and 3 have no coefficients; rows of coefficients are written without these zeros.
sum_i e_i k_i vanishes where rates are polynomials of degree 4 in the time: it tells how long a step is.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.stages import Weights, weighted_step, weighted_sum
from dq_marine.integrator.explicit import Explicit, Extent, Find, Foresee, IsStable, Taken, TakeStep

ORDER = 8


class Coefficients(NamedTuple):
    """Those of a method.

    Attributes:
        nodes: c_i.
        rows: a_ij of the stages 2 to 12.
        weights: b_i of the stages 1 and 6 to 12.
        differences: e_i of the same stages, without zeros at the end.
        largest_difference: of a step that is short enough, as a share of its rates.
    """

    nodes: Weights
    rows: tuple[Weights, ...]
    weights: Weights
    differences: Weights
    largest_difference: float


class Telling(NamedTuple):
    """sum_i e_i k_i, and the rates at the first stage and at the sixth."""

    difference: Any
    first: Any
    sixth: Any


def make_method(coefficients: Coefficients) -> Explicit:
    """Return the method with these coefficients."""
    nodes, rows, weights, differences, largest_difference = coefficients
    a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12 = rows
    telling_stages = len(differences)

    def make_step(foresee: Foresee, find: Find) -> TakeStep:
        """Return (E1): a step."""

        def step(context: Any, h: float, start: Any) -> Taken:
            s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12 = foresee(context, nodes)
            k1 = find(context, s1, start)
            k2 = find(context, s2, weighted_step(start, h, a2, (k1,)))
            k3 = find(context, s3, weighted_step(start, h, a3, (k1, k2)))
            k4 = find(context, s4, weighted_step(start, h, a4, (k1, k3)))
            k5 = find(context, s5, weighted_step(start, h, a5, (k1, k3, k4)))
            k6 = find(context, s6, weighted_step(start, h, a6, (k1, k4, k5)))
            k7 = find(context, s7, weighted_step(start, h, a7, (k1, k4, k5, k6)))
            k8 = find(context, s8, weighted_step(start, h, a8, (k1, k4, k5, k6, k7)))
            k9 = find(context, s9, weighted_step(start, h, a9, (k1, k4, k5, k6, k7, k8)))
            k10 = find(context, s10, weighted_step(start, h, a10, (k1, k4, k5, k6, k7, k8, k9)))
            k11 = find(context, s11, weighted_step(start, h, a11, (k1, k4, k5, k6, k7, k8, k9, k10)))
            k12 = find(context, s12, weighted_step(start, h, a12, (k1, k4, k5, k6, k7, k8, k9, k10, k11)))
            with_weights = (k1, k6, k7, k8, k9, k10, k11, k12)
            telling = Telling(weighted_sum(differences, with_weights[:telling_stages]), k1, k6)
            return Taken(weighted_step(start, h, weights, with_weights), telling)

        return step

    def make_is_stable(extent: Extent) -> IsStable:
        """Return whether a step was short enough (E3)."""

        def is_stable(context: Any, rates: Telling, blur: float) -> bool:
            changing = extent(context, rates.first) + extent(context, rates.sixth)
            return extent(context, rates.difference) <= largest_difference**2 * changing + blur

        return is_stable

    return Explicit(ORDER, make_step, make_is_stable)
