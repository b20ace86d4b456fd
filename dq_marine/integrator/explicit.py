"""What an explicit Runge-Kutta method is: how a step goes, and when it is short enough to be stable.

With y' = f(t, y) over a step of length h,

    y_i = y + h sum_j a_ij k_j,   k_i = f(t + c_i h, y_i),   y' = y + h sum_i b_i k_i                 (E1)

Methods know nothing of what y is but that its numbers are added. What of f depends on time alone is evaluated for all
stages at once, by `foresee`; `find` evaluates the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.stages import Weights

Foresee: TypeAlias = Callable[[Any, Weights], tuple[Any, ...]]
"""(context, shares of the step that are over at the stages) -> what is known of each stage when the step starts."""

Find: TypeAlias = Callable[[Any, Any, Any], Any]
"""(context, what is foreseen of the stage, place) -> k there, a tuple of as many numbers as the place is."""


class Taken(NamedTuple):
    """A step.

    Attributes:
        reached: the place at its end.
        rates: what is known of the k_i by which the method tells whether the step was short enough.
    """

    reached: Any
    rates: Any


TakeStep: TypeAlias = Callable[[Any, float, Any], Taken]
"""(context, length, start) -> a step."""


Extent: TypeAlias = Callable[[Any, Any], float]
"""(context, rate) -> the square of its size."""

IsStable: TypeAlias = Callable[[Any, Any, float], bool]
"""(context, rates of a step, square of a rate that says nothing) -> whether the step was short enough."""


class Explicit(NamedTuple):
    """An explicit method.

    Attributes:
        order: of convergence.
        make_step: (foresee, find) -> its step.
        make_is_stable: (extent) -> whether a step was short enough. It goes by proportions of rates: deviations that
            steps would make grow are found before they are as large as these.
    """

    order: int
    make_step: Callable[[Foresee, Find], TakeStep]
    make_is_stable: Callable[[Extent], IsStable]


def foresee_nothing(context: Any, nodes: Weights) -> tuple[Any, ...]:
    """Return the nodes, for an f of which nothing depends on time alone."""
    return nodes
