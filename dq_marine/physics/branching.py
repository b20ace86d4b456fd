"""Forces that ask `if` of a number, made callable in lanes: for one body at a time."""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import select_call, spread
from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.integrator.forces import PoseForce, TimeForce, VelocityForce


@functools.cache
def branching_pose_force(force: PoseForce) -> PoseForce:
    """Return a pose force that backends call with one body's numbers, however many they advance."""

    def pose_force(parameters: Any, pose: DualQuaternion, time: float) -> Spatial:
        like = pose.real[0]
        return select_call(spread(True, like), force, (parameters, pose, time), spread(ZERO, like))

    return pose_force


@functools.cache
def branching_time_force(force: TimeForce) -> PoseForce:
    """Return the same of a force that depends on time alone."""

    def pose_force(parameters: Any, pose: DualQuaternion, time: float) -> Spatial:
        like = pose.real[0]
        return select_call(spread(True, like), force, (parameters, time), spread(ZERO, like))

    return pose_force


@functools.cache
def branching_velocity_force(force: VelocityForce) -> VelocityForce:
    """Return a velocity force that backends call with one body's numbers, however many they advance."""

    def velocity_force(parameters: Any, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        like = pose.real[0]
        return select_call(spread(True, like), force, (parameters, pose, twist, time), spread(ZERO, like))

    return velocity_force
