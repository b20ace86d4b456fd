"""Damping as a force, for methods that take it in where they take in all forces."""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.forces import VelocityForce


@functools.cache
def make_drag(algebra: DampingAlgebra) -> VelocityForce:
    """Return (damping, pose, twist, time) -> the wrench -D(chi) chi of one kind of damping matrix."""
    damping_at, damping_apply = algebra.at, algebra.apply

    def drag(damping: Any, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        return spatial_scale(-1.0, damping_apply(damping_at(damping, twist), twist))

    return drag


@functools.cache
def make_linear_drag(algebra: DampingAlgebra) -> VelocityForce:
    """Return (D, pose, twist, time) -> the wrench -D chi of a damping matrix that does not depend on the velocity."""
    damping_apply = algebra.apply

    def drag(matrix: Any, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        return spatial_scale(-1.0, damping_apply(matrix, twist))

    return drag
