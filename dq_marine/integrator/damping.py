"""What a kick needs to know of a damping matrix; `physics.damping` has the kinds that there are."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.spatial import Spatial


class DampingAlgebra(NamedTuple):
    """The operations on one kind of damping matrix.

    at(damping, twist) is D(chi); slope(damping, twist) is the derivative of D(chi) chi;
    growth(damping, s, before, after) is s times what the diagonal of D gains between two twists;
    apply(D, chi) is D chi;
    add_scaled(m, s, D) is m + s D for a 6x6 m, and add_slope(m, s, S) the same for a slope S;
    sandwich(D, m) is D m D;
    slope_diagonal(S) is the diagonal of a slope;
    corners(damping) are the c of the forces -c |chi_k| chi_k, one for each axis.
    """

    at: Callable[..., Any]
    slope: Callable[..., Any]
    growth: Callable[..., Spatial]
    apply: Callable[..., Any]
    add_scaled: Callable[..., Any]
    add_slope: Callable[..., Any]
    sandwich: Callable[..., Any]
    slope_diagonal: Callable[..., Spatial]
    corners: Callable[..., Spatial]
