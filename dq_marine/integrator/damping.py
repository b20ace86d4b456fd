"""What a kick needs to know of a damping matrix; `physics.damping` has the kinds that there are."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.spatial import Spatial, spatial_scale

Drag: TypeAlias = Callable[[Any, Spatial], Spatial]
"""(damping matrices, twist) -> the wrench of damping."""


class DampingAlgebra(NamedTuple):
    """The operations on one kind of damping matrix.

    at(damping, twist) is D(chi); slope(damping, twist) is the derivative of D(chi) chi;
    growth(damping, s, before, after) is s times what the diagonal of D gains between two twists;
    apply(D, chi) is D chi;
    add_scaled(m, s, D) is m + s D for a 6x6 m;
    sandwich(D, m) is D m D.
    """

    at: Callable[..., Any]
    slope: Callable[..., Any]
    growth: Callable[..., Spatial]
    apply: Callable[..., Any]
    add_scaled: Callable[..., Any]
    sandwich: Callable[..., Any]


@functools.cache
def make_drag(algebra: DampingAlgebra) -> Drag:
    """Return damping as a force, -D(chi) chi, for methods that take it in like any other."""
    damping_at, damping_apply = algebra.at, algebra.apply

    def drag(damping: Any, twist: Spatial) -> Spatial:
        return spatial_scale(-1.0, damping_apply(damping_at(damping, twist), twist))

    return drag
