"""Damping matrices D(chi) = linear + diag(quadratic |chi|), diagonal or full, and what a kick does with them.

A diagonal D is held as the spatial vector of its diagonal and a full one as a 6x6 matrix. Each kind offers
the same operations under `DampingAlgebra`, so that one kick serves both and the diagonal one never
multiplies by zeros. `physics.damping.formulas.coupled` has more kinds.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_diagonal,
    matrix6_add_scaled,
    matrix6_diagonal,
    matrix6_multiply,
    matrix6_transform,
    spatial_absolute,
    spatial_add,
    spatial_multiply_elementwise,
    spatial_scale,
    spatial_scale_rows_and_columns,
    spatial_subtract,
)
from dq_marine.integrator.damping import DampingAlgebra


class DiagonalDamping(NamedTuple):
    """D = diag(linear + quadratic |chi|), per unit of twist [N m s, N s/m; quadratic: per unit of twist^2]."""

    linear: Spatial
    quadratic: Spatial


class FullDamping(NamedTuple):
    """D = linear + diag(quadratic |chi|) with any dissipative 6x6 `linear`."""

    linear: Matrix6
    quadratic: Spatial


def diagonal_at(damping: DiagonalDamping, twist: Spatial) -> Spatial:
    """Return the diagonal of D(chi)."""
    return spatial_add(
        damping.linear, spatial_multiply_elementwise(damping.quadratic, spatial_absolute(twist))
    )


def diagonal_slope(damping: DiagonalDamping, twist: Spatial) -> Spatial:
    """Return the diagonal of d(D(chi) chi)/dchi = linear + 2 quadratic |chi|."""
    return diagonal_at(DiagonalDamping(damping.linear, spatial_scale(2.0, damping.quadratic)), twist)


def own_axis_growth(
    damping: DiagonalDamping | FullDamping, s: float, before: Spatial, after: Spatial
) -> Spatial:
    """Return s quadratic (|after| - |before|)."""
    faster = spatial_subtract(spatial_absolute(after), spatial_absolute(before))
    return spatial_multiply_elementwise(spatial_scale(s, damping.quadratic), faster)


def diagonal_add_scaled(m: Matrix6, s: float, d: Spatial) -> Matrix6:
    """Return m + s diag(d)."""
    return matrix6_add_diagonal(m, spatial_scale(s, d))


def diagonal_sandwich(d: Spatial, m: Matrix6) -> Matrix6:
    """Return diag(d) m diag(d)."""
    return spatial_scale_rows_and_columns(d, m, d)


def full_at(damping: FullDamping, twist: Spatial) -> Matrix6:
    """Return D(chi)."""
    return matrix6_add_diagonal(
        damping.linear, spatial_multiply_elementwise(damping.quadratic, spatial_absolute(twist))
    )


def full_slope(damping: FullDamping, twist: Spatial) -> Matrix6:
    """Return d(D(chi) chi)/dchi."""
    return full_at(FullDamping(damping.linear, spatial_scale(2.0, damping.quadratic)), twist)


def full_sandwich(d: Matrix6, m: Matrix6) -> Matrix6:
    """Return d m d."""
    return matrix6_multiply(d, matrix6_multiply(m, d))


def diagonal_diagonal(d: Spatial) -> Spatial:
    """Return the diagonal, which is all that there is."""
    return d


def own_axis_corners(damping: DiagonalDamping | FullDamping) -> Spatial:
    """Return the quadratic coefficients."""
    return damping.quadratic


DIAGONAL = DampingAlgebra(
    at=diagonal_at,
    slope=diagonal_slope,
    growth=own_axis_growth,
    apply=spatial_multiply_elementwise,
    add_scaled=diagonal_add_scaled,
    add_slope=diagonal_add_scaled,
    sandwich=diagonal_sandwich,
    slope_diagonal=diagonal_diagonal,
    corners=own_axis_corners,
)
FULL = DampingAlgebra(
    at=full_at,
    slope=full_slope,
    growth=own_axis_growth,
    apply=matrix6_transform,
    add_scaled=matrix6_add_scaled,
    add_slope=matrix6_add_scaled,
    sandwich=full_sandwich,
    slope_diagonal=matrix6_diagonal,
    corners=own_axis_corners,
)
