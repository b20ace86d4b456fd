"""Damping as a force like any other, -D(chi) chi: explicit methods have no kick that takes it in."""

from __future__ import annotations

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_transform,
    spatial_multiply_elementwise,
    spatial_scale,
)
from dq_marine.physics.damping.formulas.diagonal import DiagonalDamping, FullDamping, diagonal_at, full_at


def diagonal_drag(damping: DiagonalDamping, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
    """Return -D(chi) chi, D = diag(linear + quadratic |chi|)."""
    return spatial_scale(-1.0, spatial_multiply_elementwise(diagonal_at(damping, twist), twist))


def full_drag(damping: FullDamping, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
    """Return -D(chi) chi, D = linear + diag(quadratic |chi|)."""
    return spatial_scale(-1.0, matrix6_transform(full_at(damping, twist), twist))


def linear_diagonal_drag(linear: Spatial, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
    """Return -diag(linear) chi."""
    return spatial_scale(-1.0, spatial_multiply_elementwise(linear, twist))


def linear_full_drag(linear: Matrix6, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
    """Return -linear chi."""
    return spatial_scale(-1.0, matrix6_transform(linear, twist))
