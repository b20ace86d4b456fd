"""What a step needs to know of moving water; `physics.current` has the water that there is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.inertia import Inertia

CURRENT_DRAWS = 2
"""Uniform random numbers that an episode's current takes."""


class CurrentDraw(NamedTuple):
    """A fixed current in NED [m/s], and a horizontal one of any direction, with a speed [m/s] of up to `speed`."""

    fixed: Vector3
    speed: float


class Placed(NamedTuple):
    """Pose and momentum relative to the water, as the water leaves them."""

    pose: DualQuaternion
    momentum: Spatial


WaterMove: TypeAlias = Callable[[Any, Inertia, float, float, DualQuaternion, Spatial], Placed]
WaterCarry: TypeAlias = Callable[[Any, float, float, DualQuaternion], DualQuaternion]
WaterPush: TypeAlias = Callable[[Any, DualQuaternion, Spatial], Spatial]


class WaterAtStages(NamedTuple):
    """What moving water does at the stages of a step.

    Attributes:
        carry: (parameters, time, elapsed, pose) -> pose that the water has carried along for `elapsed` seconds from
            `time`.
        push: (parameters, pose, wrench) -> wrench, and what the momentum relative to the water gains because the water
            accelerates.
    """

    carry: WaterCarry
    push: WaterPush


class Water(NamedTuple):
    """What moving water does. Its parameters come first everywhere but in `draw`.

    Attributes:
        draw: (CurrentDraw, uniform, uniform) -> velocity in NED that an episode begins with.
        flow: (parameters, velocity in NED) -> parameters of water that begins with this velocity.
        depart: (parameters, inertia, time, h, pose, momentum) -> Placed: what the water does in the first half of a
            drift from `time` to `time + h`, taken before it.
        arrive: the same for the second half, taken after it.
        at_stages: the same for methods with stages; None where the velocity depends on the depth.
        velocity: (parameters, pose) -> velocity in NED where the body is.
        twist: (parameters, pose) -> the same as a twist in the body frame.
        evolve: (parameters, time, uniforms) -> parameters for the control period that begins at `time`.
        draws: uniform random numbers that `evolve` takes; with 0 it changes nothing.
    """

    draw: Callable[[CurrentDraw, float, float], Vector3]
    flow: Callable[[Any, Vector3], Any]
    depart: WaterMove
    arrive: WaterMove
    at_stages: WaterAtStages | None
    velocity: Callable[[Any, DualQuaternion], Vector3]
    twist: Callable[[Any, DualQuaternion], Spatial]
    evolve: Callable[[Any, float, Any], Any]
    draws: int


def leave_wrench(parameters: Any, pose: DualQuaternion, wrench: Spatial) -> Spatial:
    """Return the wrench: this water does not accelerate."""
    return wrench


def at_stages(water: Water) -> WaterAtStages:
    """Return what water does at the stages of a step.

    Raises:
        TypeError: its velocity depends on the depth; scenes refuse that before.
    """
    if water.at_stages is None:
        raise TypeError("the velocity of this water depends on the depth")
    return water.at_stages
