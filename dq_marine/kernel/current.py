"""Uniform steady current, by integrating in the frame that drifts with the water.

That frame is inertial, so the body's momentum relative to the water obeys the still-water equations with the
same M, and the position in NED only gains v_c h in every step: exact, whatever the step.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.kernel.dual_quaternion import DualQuaternion, pose_translate
from dq_marine.kernel.quaternion import rotate_inverse
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.vector3 import Vector3, scale


class UniformCurrent(NamedTuple):
    """Velocity of the water in NED [m/s]."""

    velocity: Vector3


class Water(NamedTuple):
    """What moving water does.

    Attributes:
        flow: (velocity in NED) -> parameters.
        carry: (parameters, h, pose) -> pose.
        twist: (parameters, pose) -> its velocity in the body frame.
    """

    flow: Callable[[Vector3], Any]
    carry: Callable[[Any, float, DualQuaternion], DualQuaternion]
    twist: Callable[[Any, DualQuaternion], Spatial]


def carry_with_current(current: UniformCurrent, h: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose displaced by the water's way in h seconds."""
    return pose_translate(pose, scale(h, current.velocity))


def current_twist(current: UniformCurrent, pose: DualQuaternion) -> Spatial:
    """Return the water's velocity as a twist in the body frame."""
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, current.velocity))


def no_flow(velocity: Vector3) -> tuple[()]:
    """Return the parameters of still water: none."""
    return ()


def uniform_flow(velocity: Vector3) -> UniformCurrent:
    """Return the parameters of water that moves with a velocity in NED [m/s]."""
    return UniformCurrent(velocity)


def carry_nothing(parameters: Any, h: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose."""
    return pose


def no_twist(parameters: Any, pose: DualQuaternion) -> Spatial:
    """Return zero."""
    return Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


STILL_WATER = Water(no_flow, carry_nothing, no_twist)
MOVING_WATER = Water(uniform_flow, carry_with_current, current_twist)
