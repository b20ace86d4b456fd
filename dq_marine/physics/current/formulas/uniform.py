"""What moving water does to a step, and the water that is still or moves uniformly and steadily.

A uniform steady current is taken in the frame that drifts with the water. That frame is inertial, so the body's
momentum relative to the water obeys the still-water equations with the same M, and the position in NED only gains v_c h
in every step: exact, whatever the step. Water that moves otherwise is in `physics.current.formulas.sheared` and
`physics.current.formulas.unsteady`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_translate
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.algebra.vector3 import Vector3, add, scale
from dq_marine.integrator.inertia import Inertia
from dq_marine.integrator.water import CurrentDraw, Placed, Water, WaterAtStages, as_it_is


class UniformFlow(NamedTuple):
    """Velocity of the water in NED [m/s]."""

    velocity: Vector3


def draw_current(draw: CurrentDraw, of_speed: float, of_direction: float) -> Vector3:
    """Return a current in NED [m/s], from two uniform random numbers in [0, 1)."""
    speed = draw.speed * of_speed
    direction = math.pi * (2.0 * of_direction - 1.0)
    return add(draw.fixed, (speed * math.cos(direction), speed * math.sin(direction), 0.0))


def carry_with_current(
    current: UniformFlow, time: float, elapsed: float, pose: DualQuaternion
) -> DualQuaternion:
    """Return the pose displaced by the water's way in `elapsed` seconds."""
    return pose_translate(pose, scale(elapsed, current.velocity))


def carry_nothing(parameters: Any, time: float, elapsed: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose."""
    return pose


def leave_be(
    parameters: Any, inertia: Inertia, time: float, h: float, pose: DualQuaternion, momentum: Spatial
) -> Placed:
    """Return pose and momentum."""
    return Placed(pose, momentum)


def displace(
    current: UniformFlow, inertia: Inertia, time: float, h: float, pose: DualQuaternion, momentum: Spatial
) -> Placed:
    """Return the pose displaced by the water's way in all of h, and the momentum: neither half matters to the other."""
    return Placed(carry_with_current(current, time, h, pose), momentum)


def current_velocity(current: UniformFlow, pose: DualQuaternion) -> Vector3:
    """Return the water's velocity in NED [m/s]."""
    return current.velocity


def current_twist(current: UniformFlow, pose: DualQuaternion) -> Spatial:
    """Return the water's velocity as a twist in the body frame."""
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, current.velocity))


def no_flow(parameters: tuple[()], velocity: Vector3) -> tuple[()]:
    """Return the parameters of still water: none."""
    return ()


def uniform_flow(current: UniformFlow, velocity: Vector3) -> UniformFlow:
    """Return the parameters of water that moves with a velocity in NED [m/s]."""
    return UniformFlow(velocity)


def no_velocity(parameters: Any, pose: DualQuaternion) -> Vector3:
    """Return zero."""
    return (0.0, 0.0, 0.0)


def no_twist(parameters: Any, pose: DualQuaternion) -> Spatial:
    """Return zero."""
    return ZERO


def stay(parameters: Any, time: float, uniforms: Any) -> Any:
    """Return the parameters: this water does not change by itself."""
    return parameters


STILL = WaterAtStages(carry_nothing, as_it_is, as_it_is)
MOVING = WaterAtStages(carry_with_current, as_it_is, as_it_is)

STILL_WATER = Water(draw_current, no_flow, leave_be, leave_be, STILL, no_velocity, no_twist, stay, 0)
MOVING_WATER = Water(
    draw_current, uniform_flow, leave_be, displace, MOVING, current_velocity, current_twist, stay, 0
)
