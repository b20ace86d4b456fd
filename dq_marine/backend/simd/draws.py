"""What lanes draw at random: how an episode begins, and the numbers of a control period, body by body."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from numba.cpython.unsafe.tuple import tuple_setitem

from dq_marine.algebra.selection import select_call, spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.packing import make_load, structure_type
from dq_marine.backend.pcg64 import next_uniform
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.integrator.water import CurrentDraw
from dq_marine.task.episode import EpisodeTask
from dq_marine.task.period import PeriodUniforms
from dq_marine.task.protocol import Start
from dq_marine.task.start import CLOCK_SPAN, Drawn, beginning_draws, make_beginning, make_draw


def choose(chosen: float, drawn: float) -> float:
    """Return what was chosen, unless it is NaN."""
    return drawn if chosen != chosen else chosen


def choose3(chosen: Any, first: int, drawn: Any) -> Any:
    """Return three numbers, those that were chosen from the index `first` on, unless they are NaN."""
    return (
        choose(chosen[first], drawn[0]),
        choose(chosen[first + 1], drawn[1]),
        choose(chosen[first + 2], drawn[2]),
    )


def as_chosen_in(chosen: Any, drawn: Drawn) -> Drawn:
    """Return what was drawn, but for what was chosen: a row of `PeriodArrays.chosen`."""
    start = drawn.start
    q = start.attitude
    attitude = (choose(chosen[3], q[0]), *choose3(chosen, 4, (q[1], q[2], q[3])))
    velocity = Spatial(choose3(chosen, 10, start.velocity.angular), choose3(chosen, 7, start.velocity.linear))
    return Drawn(
        Start(choose3(chosen, 0, start.position_ned), attitude, velocity),
        choose3(chosen, 13, drawn.current_ned),
        drawn.for_task,
        drawn.for_sensing,
    )


CHOSEN_COLUMNS = 16


def draw_clock(generators: Any, clocks: Any, body: int) -> None:
    """Set the time at an episode's beginning, from one more uniform number."""
    clocks[body] = CLOCK_SPAN * next_uniform(generators[body])


def draw_no_clock(generators: Any, clocks: Any, body: int) -> None:
    """Leave the time at an episode's beginning at 0: the weather does not change."""


@functools.cache
def make_draw_uniforms(count: int) -> Callable[[Any, int], tuple[float, ...]]:
    """Return (generators, body) -> uniform random numbers, as many as `count`, from a body's generator."""
    zeros = (0.0,) * count

    def draw_uniforms(generators: Any, body: int) -> tuple[float, ...]:
        uniforms = zeros
        for index in range(count):
            uniforms = tuple_setitem(uniforms, index, next_uniform(generators[body]))
        return uniforms

    return draw_uniforms


@functools.cache
def make_begin_one(composition: Composition, task: EpisodeTask, time_varying: bool) -> Callable[..., Any]:
    """Return (generators, clocks, chosen, currents, body, parameters, episode) -> Beginning, for one body."""
    draw, begin = make_draw(composition, task), make_beginning(composition, task)
    load_currents = make_load(structure_type(CurrentDraw((0.0, 0.0, 0.0), 0.0)))
    set_clock = draw_clock if time_varying else draw_no_clock
    draw_uniforms = make_draw_uniforms(beginning_draws(task))

    def begin_one(
        generators: Any,
        clocks: Any,
        chosen: Any,
        currents: Any,
        body: int,
        parameters: StepParameters,
        episode: Any,
    ) -> Any:
        uniforms = draw_uniforms(generators, body)
        set_clock(generators, clocks, body)
        row = chosen[min(body, len(chosen) - 1)]  # there is only one where nothing is chosen for any body
        drawn = as_chosen_in(row, draw(episode, load_currents(currents), uniforms))
        return begin(parameters, episode, drawn)

    return begin_one


@functools.cache
def make_lane_uniforms(for_water: int, for_sensing: int) -> Callable[..., PeriodUniforms]:
    """Return (wanted, generators, bodies, like) -> uniform numbers for a control period, drawn where wanted."""
    count = for_water + for_sensing
    none, zeros = PeriodUniforms((), ()), PeriodUniforms((0.0,) * for_water, (0.0,) * for_sensing)
    draw_uniforms = make_draw_uniforms(count)

    def draw_nothing(wanted: bool, generators: Any, bodies: int, like: float) -> PeriodUniforms:
        return none

    def draw_one(generators: Any, body: int) -> PeriodUniforms:
        uniforms = draw_uniforms(generators, body)
        return PeriodUniforms(uniforms[:for_water], uniforms[for_water:])

    def draw_lanes(wanted: bool, generators: Any, bodies: int, like: float) -> PeriodUniforms:
        return select_call(wanted, draw_one, (generators, bodies), spread(zeros, like))

    return draw_lanes if count else draw_nothing
