"""What an explicit Runge-Kutta method is: how a step goes, and when it is short enough to be stable.

With y' = f(t, y) over a step that lasts 1,

    y_i = y + sum_j a_ij k_j,   k_i = f(c_i, y_i),   y' = y + sum_i b_i k_i                           (E1)

Methods know nothing of what y is: `find` evaluates f, and `follow` moves a place by a change.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

Find: TypeAlias = Callable[[Any, float, Any], Any]
"""(context, share of the step that is over, place) -> k there, over a step that lasts 1."""

Follow: TypeAlias = Callable[[Any, Any], Any]
"""(place, change) -> the place after it."""


class Taken(NamedTuple):
    """A step.

    Attributes:
        change: sum of b_i k_i.
        rates: what is known of the k_i by which the method tells whether the step was short enough.
    """

    change: Any
    rates: Any


TakeStep: TypeAlias = Callable[[Any, Any], Taken]
"""(context, start) -> a step."""


Extent: TypeAlias = Callable[[Any, Any], float]
"""(context, change) -> the square of its size."""

IsStable: TypeAlias = Callable[[Any, Any, float], bool]
"""(context, rates of a step, square of a change that says nothing) -> whether the step was short enough."""


class Explicit(NamedTuple):
    """An explicit method.

    Attributes:
        order: of convergence.
        make_step: (find, follow) -> its step.
        make_is_stable: (extent) -> whether a step was short enough. It goes by proportions of rates: deviations that
            steps would make grow are found before they are as large as these.
    """

    order: int
    make_step: Callable[[Find, Follow], TakeStep]
    make_is_stable: Callable[[Extent], IsStable]
