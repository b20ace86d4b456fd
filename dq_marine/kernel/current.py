"""What moving water does to a step, and the water that is still or moves uniformly and steadily.

A uniform steady current is taken in the frame that drifts with the water. That frame is inertial, so the body's
momentum relative to the water obeys the still-water equations with the same M, and the position in NED only gains v_c h
in every step: exact, whatever the step. Water that moves otherwise is in `kernel.sheared_current` and
`kernel.unsteady_current`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.kernel.dual_quaternion import DualQuaternion, pose_translate
from dq_marine.kernel.inertia import Inertia
from dq_marine.kernel.quaternion import rotate_inverse
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.vector3 import Vector3, add, scale

CURRENT_DRAWS = 2
"""Uniform random numbers that an episode's current takes."""


class CurrentDraw(NamedTuple):
    """A fixed current in NED [m/s], and a horizontal one of any direction, with a speed [m/s] of up to `speed`."""

    fixed: Vector3
    speed: float


class UniformCurrent(NamedTuple):
    """Velocity of the water in NED [m/s]."""

    velocity: Vector3


class Placed(NamedTuple):
    """Pose and momentum relative to the water, as the water leaves them."""

    pose: DualQuaternion
    momentum: Spatial


WaterMove: TypeAlias = Callable[[Any, Inertia, float, float, DualQuaternion, Spatial], Placed]


class Water(NamedTuple):
    """What moving water does. Its parameters come first everywhere but in `draw`.

    Attributes:
        draw: (CurrentDraw, uniform, uniform) -> velocity in NED that an episode begins with.
        flow: (parameters, velocity in NED) -> parameters of water that begins with this velocity.
        depart: (parameters, inertia, time, h, pose, momentum) -> Placed: what the water does in the first half of a
            drift from `time` to `time + h`, taken before it.
        arrive: the same for the second half, taken after it.
        velocity: (parameters, pose) -> velocity in NED where the body is.
        twist: (parameters, pose) -> the same as a twist in the body frame.
        evolve: (parameters, time, uniforms) -> parameters for the control period that begins at `time`.
        draws: uniform random numbers that `evolve` takes; with 0 it changes nothing.
    """

    draw: Callable[[CurrentDraw, float, float], Vector3]
    flow: Callable[[Any, Vector3], Any]
    depart: WaterMove
    arrive: WaterMove
    velocity: Callable[[Any, DualQuaternion], Vector3]
    twist: Callable[[Any, DualQuaternion], Spatial]
    evolve: Callable[[Any, float, Any], Any]
    draws: int


def draw_current(draw: CurrentDraw, of_speed: float, of_direction: float) -> Vector3:
    """Return a current in NED [m/s], from two uniform random numbers in [0, 1)."""
    speed = draw.speed * of_speed
    direction = math.pi * (2.0 * of_direction - 1.0)
    return add(draw.fixed, (speed * math.cos(direction), speed * math.sin(direction), 0.0))


def carry_with_current(current: UniformCurrent, h: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose displaced by the water's way in h seconds."""
    return pose_translate(pose, scale(h, current.velocity))


def carry_nothing(parameters: Any, h: float, pose: DualQuaternion) -> DualQuaternion:
    """Return the pose."""
    return pose


def leave_be(
    parameters: Any, inertia: Inertia, time: float, h: float, pose: DualQuaternion, momentum: Spatial
) -> Placed:
    """Return pose and momentum."""
    return Placed(pose, momentum)


def displace(
    current: UniformCurrent, inertia: Inertia, time: float, h: float, pose: DualQuaternion, momentum: Spatial
) -> Placed:
    """Return the pose displaced by the water's way in all of h, and the momentum: neither half matters to the other."""
    return Placed(carry_with_current(current, h, pose), momentum)


def current_velocity(current: UniformCurrent, pose: DualQuaternion) -> Vector3:
    """Return the water's velocity in NED [m/s]."""
    return current.velocity


def current_twist(current: UniformCurrent, pose: DualQuaternion) -> Spatial:
    """Return the water's velocity as a twist in the body frame."""
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, current.velocity))


def no_flow(parameters: tuple[()], velocity: Vector3) -> tuple[()]:
    """Return the parameters of still water: none."""
    return ()


def uniform_flow(current: UniformCurrent, velocity: Vector3) -> UniformCurrent:
    """Return the parameters of water that moves with a velocity in NED [m/s]."""
    return UniformCurrent(velocity)


def no_velocity(parameters: Any, pose: DualQuaternion) -> Vector3:
    """Return zero."""
    return (0.0, 0.0, 0.0)


def no_twist(parameters: Any, pose: DualQuaternion) -> Spatial:
    """Return zero."""
    return Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def stay(parameters: Any, time: float, uniforms: Any) -> Any:
    """Return the parameters: this water does not change by itself."""
    return parameters


STILL_WATER = Water(draw_current, no_flow, leave_be, leave_be, no_velocity, no_twist, stay, 0)
MOVING_WATER = Water(draw_current, uniform_flow, leave_be, displace, current_velocity, current_twist, stay, 0)
