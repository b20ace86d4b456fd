"""The classical explicit Runge-Kutta method of order 4 (E1), with four stages.

For y' = z y, k_3 - k_2 = (z/2) (k_2 - k_1) = (z/2)^2 k_1: differences of rates tell how long a step is.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.stages import Weights, weighted_step, weighted_sum
from dq_marine.integrator.explicit import Explicit, Extent, Find, Foresee, IsStable, Taken, TakeStep

NODES: Weights = (0.0, 0.5, 1.0)
"""c_1, c_2 = c_3 and c_4."""

HALF: Weights = (0.5,)
WHOLE: Weights = (1.0,)
DIFFERENCE: Weights = (1.0, -1.0)
WEIGHTS: Weights = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
"""b_i."""

LARGEST_HALF = 1.31
"""Of |z|: up to there the method is stable for every z whose real part is not positive."""


class Telling(NamedTuple):
    """k_3 - k_2, k_2 - k_1, and k_1."""

    second_difference: Any
    first_difference: Any
    first: Any


def make_step(foresee: Foresee, find: Find) -> TakeStep:
    """Return (E1): a step."""

    def step(context: Any, h: float, start: Any) -> Taken:
        early, middle, late = foresee(context, NODES)
        k1 = find(context, early, start)
        k2 = find(context, middle, weighted_step(start, h, HALF, (k1,)))
        k3 = find(context, middle, weighted_step(start, h, HALF, (k2,)))
        k4 = find(context, late, weighted_step(start, h, WHOLE, (k3,)))
        telling = Telling(weighted_sum(DIFFERENCE, (k3, k2)), weighted_sum(DIFFERENCE, (k2, k1)), k1)
        return Taken(weighted_step(start, h, WEIGHTS, (k1, k2, k3, k4)), telling)

    return step


def make_is_stable(extent: Extent) -> IsStable:
    """Return whether a step was short enough.

    It is if one of both proportions says so: in an oscillation k_2 - k_1 passes through zero where k_1 does not, and
    under forces that change with time it is the other way round.
    """

    def is_stable(context: Any, rates: Telling, blur: float) -> bool:
        by_difference = LARGEST_HALF**2 * extent(context, rates.first_difference)
        by_rate = LARGEST_HALF**4 * extent(context, rates.first)
        return extent(context, rates.second_difference) <= max(by_difference, by_rate) + blur

    return is_stable


CLASSICAL = Explicit(4, make_step, make_is_stable)
