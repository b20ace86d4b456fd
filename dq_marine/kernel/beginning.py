"""How an episode begins: drawn from random numbers, then placed and observed, by the same formulas for one and many."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.kernel.body import BodyState
from dq_marine.kernel.current import CURRENT_DRAWS, CurrentDraw
from dq_marine.kernel.step import Composition, StepParameters, in_water, make_motion, make_placement
from dq_marine.kernel.task import Start, Task
from dq_marine.kernel.vector3 import Vector3

CLOCK_SPAN = 1e4
"""Episodes in weather that changes begin at a time drawn from this many seconds: each meets another stretch of it."""


class Drawn(NamedTuple):
    """What an episode begins with: the start, the current in NED [m/s], and uniforms for the first measurement."""

    start: Start
    current_ned: Vector3
    for_sensing: tuple[float, ...]


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


def beginning_draws(task: Task) -> int:
    """Return how many uniform random numbers an episode's beginning takes."""
    return CURRENT_DRAWS + task.draws + task.sensing.first_draws


def make_draw(composition: Composition, task: Task) -> Callable[[Any, CurrentDraw, tuple[float, ...]], Drawn]:
    """Return (task parameters, current draw, uniforms) -> Drawn; there are `beginning_draws` uniforms."""
    start_of, current_of = task.start, composition.water.draw
    sensing_from = CURRENT_DRAWS + task.draws

    def draw(aim: Any, currents: CurrentDraw, uniforms: tuple[float, ...]) -> Drawn:
        current = current_of(currents, uniforms[0], uniforms[1])
        return Drawn(start_of(aim, uniforms[CURRENT_DRAWS:]), current, uniforms[sensing_from:])

    return draw


def make_beginning(composition: Composition, task: Task) -> Callable[[StepParameters, Any, Drawn], Beginning]:
    """Return (parameters, task parameters, drawn) -> Beginning."""
    flow = composition.water.flow
    place, motion_of = make_placement(composition), make_motion(composition)
    forget, sense, observe, judge = task.forget, task.sensing.first, task.observe, task.judge

    def begin(parameters: StepParameters, aim: Any, drawn: Drawn) -> Beginning:
        start, flowing = drawn.start, in_water(parameters, flow(parameters.water, drawn.current_ned))
        state = place(flowing, start.position_ned, start.attitude, start.velocity)
        motion = motion_of(flowing, state)
        memory = sense(aim, forget(aim), motion, drawn.for_sensing)
        measures = judge(aim, motion, 0.0).measures
        return Beginning(flowing.water, state, memory, observe(aim, memory, motion), measures)

    return begin
