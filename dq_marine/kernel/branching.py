"""Forces that ask `if` of a number, made callable in lanes: for one body at a time."""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.kernel.dual_quaternion import DualQuaternion
from dq_marine.kernel.forces import PoseForce, VelocityForce
from dq_marine.kernel.selection import select_call, spread
from dq_marine.kernel.spatial import Spatial

NO_WRENCH = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@functools.cache
def branching_pose_force(force: PoseForce) -> PoseForce:
    """Return a pose force that engines call with one body's numbers, however many they advance."""

    def pose_force(parameters: Any, pose: DualQuaternion, time: float) -> Spatial:
        like = pose.real[0]
        return select_call(spread(True, like), force, (parameters, pose, time), spread(NO_WRENCH, like))

    return pose_force


@functools.cache
def branching_velocity_force(force: VelocityForce) -> VelocityForce:
    """Return a velocity force that engines call with one body's numbers, however many they advance."""

    def velocity_force(parameters: Any, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        like = pose.real[0]
        return select_call(
            spread(True, like), force, (parameters, pose, twist, time), spread(NO_WRENCH, like)
        )

    return velocity_force
