"""What a step needs to know of moving water; `physics.current` has the water that there is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias, TypeVar

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.inertia import Inertia
from dq_marine.integrator.staged import StageForces, Step

Function = TypeVar("Function")

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


class WaterAtStages(NamedTuple):
    """What moving water does to methods with stages.

    Attributes:
        carry: (parameters, time, elapsed, pose) -> pose that the water has carried along for `elapsed` seconds from
            `time`.
        forces: (forces in still water) -> forces in this water; `as_it_is` if they are the same.
        step: (step in uniform water) -> step in this water, whose momentum is that relative to the water where the
            body is; `as_it_is` if they are the same.
    """

    carry: WaterCarry
    forces: Callable[[StageForces], StageForces]
    step: Callable[[Step], Step]


class Water(NamedTuple):
    """What moving water does. Its parameters come first everywhere but in `draw`.

    Attributes:
        draw: (CurrentDraw, uniform, uniform) -> velocity in NED that an episode begins with.
        flow: (parameters, velocity in NED) -> parameters of water that begins with this velocity.
        depart: (parameters, inertia, time, h, pose, momentum) -> Placed: what the water does in the first half of a
            drift from `time` to `time + h`, taken before it.
        arrive: the same for the second half, taken after it.
        at_stages: the same for methods with stages.
        velocity: (parameters, pose) -> velocity in NED where the body is.
        twist: (parameters, pose) -> the same as a twist in the body frame.
        evolve: (parameters, time, uniforms) -> parameters for the control period that begins at `time`.
        draws: uniform random numbers that `evolve` takes; with 0 it changes nothing.
    """

    draw: Callable[[CurrentDraw, float, float], Vector3]
    flow: Callable[[Any, Vector3], Any]
    depart: WaterMove
    arrive: WaterMove
    at_stages: WaterAtStages
    velocity: Callable[[Any, DualQuaternion], Vector3]
    twist: Callable[[Any, DualQuaternion], Spatial]
    evolve: Callable[[Any, float, Any], Any]
    draws: int


def as_it_is(function: Function) -> Function:
    """Return the function: this water changes nothing about it."""
    return function
