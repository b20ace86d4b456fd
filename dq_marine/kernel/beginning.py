"""How an episode begins: drawn from random numbers, then placed and observed, by the same formulas for one and many."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.kernel.body import BodyState
from dq_marine.kernel.step import Composition, StepParameters, make_motion, make_placement
from dq_marine.kernel.task import Start, Task
from dq_marine.kernel.vector3 import Vector3, add

CURRENT_DRAWS = 2
"""Uniform random numbers that a current takes."""

CLOCK_SPAN = 1e4
"""Episodes in weather that changes begin at a time drawn from this many seconds: each meets another stretch of it."""


class CurrentDraw(NamedTuple):
    """A fixed current in NED [m/s], and a horizontal one of any direction, with a speed [m/s] of up to `speed`."""

    fixed: Vector3
    speed: float


class Drawn(NamedTuple):
    """What an episode begins with: the start, and the current in NED [m/s]."""

    start: Start
    current_ned: Vector3


class Beginning(NamedTuple):
    """A begun episode.

    Attributes:
        water: the water's parameters.
        state: of the body.
        memory: of the task.
        observation: nested tuples of numbers.
        measures: as in `kernel.task.Verdict`.
    """

    water: Any
    state: BodyState
    memory: Any
    observation: Any
    measures: tuple[float, ...]


def draw_current(draw: CurrentDraw, of_speed: float, of_direction: float) -> Vector3:
    """Return a current in NED [m/s], from two uniform random numbers in [0, 1)."""
    speed = draw.speed * of_speed
    direction = math.pi * (2.0 * of_direction - 1.0)
    return add(draw.fixed, (speed * math.cos(direction), speed * math.sin(direction), 0.0))


def in_water(parameters: StepParameters, water: Any) -> StepParameters:
    """Return the parameters in other water."""
    return StepParameters(parameters.inertia, parameters.damping, parameters.forces, water, parameters.timing)


def make_draw(task: Task) -> Callable[[Any, CurrentDraw, tuple[float, ...]], Drawn]:
    """Return (task parameters, current draw, uniforms) -> Drawn; there are `CURRENT_DRAWS + task.draws` uniforms."""
    start_of = task.start

    def draw(aim: Any, currents: CurrentDraw, uniforms: tuple[float, ...]) -> Drawn:
        current = draw_current(currents, uniforms[0], uniforms[1])
        return Drawn(start_of(aim, uniforms[CURRENT_DRAWS:]), current)

    return draw


def make_beginning(composition: Composition, task: Task) -> Callable[[StepParameters, Any, Drawn], Beginning]:
    """Return (parameters, task parameters, drawn) -> Beginning."""
    flow = composition.water.flow
    place, motion_of = make_placement(composition), make_motion(composition)
    forget, observe, judge = task.forget, task.observe, task.judge

    def begin(parameters: StepParameters, aim: Any, drawn: Drawn) -> Beginning:
        start, flowing = drawn.start, in_water(parameters, flow(drawn.current_ned))
        state = place(flowing, start.position_ned, start.attitude, start.velocity)
        memory, motion = forget(aim), motion_of(flowing, state)
        measures = judge(aim, motion, 0.0).measures
        return Beginning(flowing.water, state, memory, observe(aim, memory, motion), measures)

    return begin
