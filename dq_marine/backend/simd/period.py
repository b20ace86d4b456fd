"""One control period of many bodies' task, in SIMD lanes: actions in, observations, verdicts and new episodes out."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from numba import types

from dq_marine.algebra.selection import negation, select, select_call, some, spread
from dq_marine.algebra.vector3 import dot
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.simd.draws import make_begin_one, make_lane_uniforms
from dq_marine.backend.simd.packing import Packing, make_load_block, make_store_block
from dq_marine.backend.simd.rows import (
    lane_numbers,
    make_load_column,
    make_load_rows,
    store_columns,
    store_rows,
)
from dq_marine.backend.simd.vehicles import PoolLayout, make_renew_vehicle
from dq_marine.integrator.step import ACCEPTED, Composition, StepParameters, in_water, make_motion
from dq_marine.task.action import action_size, make_saturated
from dq_marine.task.episode import EpisodeTask, make_shown
from dq_marine.task.period import make_control_period
from dq_marine.task.start import Beginning, make_first_report


@dataclass(frozen=True)
class PeriodLayout:
    """How environments lie in memory: the type of their own numbers, a packing for each structure, and a pool's layout.

    There is no pool where episodes keep their vehicle. `time_varying` is whether episodes begin at a time of their own,
    which is drawn.
    """

    lanes: Lanes
    parameters: Packing
    episode: Packing
    state: Packing
    memory: Packing
    outcome: Packing
    pool: PoolLayout | None = None
    time_varying: bool = False

    @property
    def key(self) -> str:
        """Text that tells layouts apart."""
        packings = (self.parameters, self.episode, self.state, self.memory, self.outcome)
        return "|".join([str(self.lanes), *(packing.key for packing in packings), str(self.pool)])


class PeriodArrays(NamedTuple):
    """The memory of a batch of environments, padded to whole blocks.

    Blocks as in `backend.simd.packing`, each with the array of what is shared:

    Attributes:
        shared: shared parameters of the step.
        parameters: the others.
        shared_episode: shared parameters of the episodes.
        episodes: the others.
        default_episodes: those that an episode begins with, unless told otherwise.
        states: of the bodies.
        memories: of the task.
        outcomes: (status, completed, fallbacks, residual squared, spin squared, speed squared) of the last period.
        generators: random number generators, see `backend.pcg64`, shape (bodies, 4).
        pool: vehicles to draw from, a row each, see `backend.simd.vehicles`.
        vehicles: numbers of those drawn.
        currents: `CurrentDraw`, packed.
        chosen: what is not drawn at a `begin`: position, quaternion, velocity (Fossen's order), current; NaN if drawn;
            one row for all where nothing is chosen.
        periods: control periods since the episode began.
        clocks: time at the episode's beginning [s].
        ended: whether the last period ended the episode.
        observations: shape (bodies, observed).
        final_observations: the same of episodes that ended in the last period; without rows where those that follow
            begin in the next step, and end and beginning are told one after the other.
        rewards: of the last period.
        terminated: whether the task ended.
        truncated: whether the time limit was met.
        reports: `task.episode.Report` at the period's end and the current in NED, a row for each number.
        final_reports: the same of episodes that ended in the last period; likewise.
    """

    shared: Any
    parameters: Any
    shared_episode: Any
    episodes: Any
    default_episodes: Any
    states: Any
    memories: Any
    outcomes: Any
    generators: Any
    pool: Any
    vehicles: Any
    currents: Any
    chosen: Any
    periods: Any
    clocks: Any
    ended: Any
    observations: Any
    final_observations: Any
    rewards: Any
    terminated: Any
    truncated: Any
    reports: Any
    final_reports: Any


def renew_at_next_step(waiting: bool, ended: bool) -> tuple[bool, bool]:
    """Return which episodes are renewed now, and which wait: one that ended is renewed by the step after."""
    return waiting, ended


def renew_at_same_step(waiting: bool, ended: bool) -> tuple[bool, bool]:
    """Return which episodes are renewed now, and which wait: one that ended is renewed at once, none waits."""
    return ended, waiting & negation(ended)


def make_time(layout: PeriodLayout, load_numbers: Callable[..., Any]) -> Callable[..., float]:
    """Return (clocks, block, time since the episodes' beginning) -> time [s]."""

    def time_by_clock(clocks: Any, block: int, elapsed: float) -> float:
        return elapsed + load_numbers(clocks, block)

    def time_from_zero(clocks: Any, block: int, elapsed: float) -> float:
        return elapsed

    return time_by_clock if layout.time_varying else time_from_zero


def keep_ends(arrays: PeriodArrays, block: int, ended: bool, end: Beginning) -> None:
    """Keep what episodes ended with: new ones take their places in the same step."""
    if some(ended):
        store_rows(arrays.final_observations, block, end.observation)
        store_columns(arrays.final_reports, block, (end.report, end.current_ned))


def keep_no_ends(arrays: PeriodArrays, block: int, ended: bool, end: Beginning) -> None:
    """Leave what episodes end with where it is told."""


def keep_nothing(blocks: Any, block: int, parameters: StepParameters) -> None:
    """Leave the parameters: their water does not change by itself."""


@functools.cache
def compiled_begin(composition: Composition, task: EpisodeTask, layout: PeriodLayout) -> Callable[..., Any]:
    """Compile (first, last, arrays, wanted): new episodes where `wanted` is set, with the episodes that stand there.

    Blocks first <= k < last; `wanted` holds a bool for every lane.
    """
    readers, writers = _Readers(layout), _Writers(layout)
    load_parameters, load_episode, load_state = readers.parameters, readers.episode, readers.state
    load_memory, load_flags = readers.memory, readers.flags
    store_state, store_memory, store_parameters = writers.state, writers.memory, writers.parameters
    store_episode, renew_vehicle = writers.episode, make_renew_vehicle(layout.pool, layout.lanes)
    begin_one, motion_of = make_begin_one(composition, task, layout.time_varying), make_motion(composition)
    show, first_report = make_shown(task), make_first_report(task)
    velocity = composition.water.velocity

    def begin_blocks(first: int, last: int, arrays: PeriodArrays, wanted: Any) -> None:
        for block in range(first, last):
            renewed = load_flags(wanted, block)
            if some(renewed):
                parameters = load_parameters(arrays.shared, arrays.parameters, block)
                episode = load_episode(arrays.shared_episode, arrays.episodes, block)
                state = load_state(arrays.shared, arrays.states, block)
                memory = load_memory(arrays.shared, arrays.memories, block)
                motion = motion_of(parameters, state)
                current_ned = spread(velocity(parameters.water, state.pose), motion.position_ned[0])
                going_on = Beginning(
                    parameters.water,
                    current_ned,
                    state,
                    memory,
                    show(episode, memory, motion, current_ned),
                    first_report(episode, memory, motion),
                )
                bodies = lane_numbers(motion.position_ned[0], block)
                parameters, episode = renew_vehicle(renewed, arrays, block, bodies, parameters, episode)
                arguments = (
                    arrays.generators,
                    arrays.clocks,
                    arrays.chosen,
                    arrays.currents,
                    bodies,
                    parameters,
                    episode,
                )
                begun = select_call(renewed, begin_one, arguments, going_on)
                store_state(arrays.states, block, begun.state)
                store_memory(arrays.memories, block, begun.memory)
                store_parameters(arrays.parameters, block, in_water(parameters, begun.water))
                store_episode(arrays.episodes, block, episode)
                store_rows(arrays.observations, block, begun.observation)
                store_columns(arrays.reports, block, (begun.report, begun.current_ned))

    return compile_function(begin_blocks, layout.key)


@functools.cache
def compiled_period(
    composition: Composition, task: EpisodeTask, layout: PeriodLayout, renewal: Callable[[bool, bool], Any]
) -> Callable[..., Any]:
    """Compile (first, last, arrays, actions, period, steps, most_periods): one control period of a range of blocks.

    `actions` has a row for every environment, saturated here; `period` [s] is divided into `steps`; an
    episode is truncated after `most_periods`. `renewal` is `renew_at_next_step` or `renew_at_same_step`.
    """
    readers, writers = _Readers(layout), _Writers(layout)
    load_parameters, load_episode, load_state = readers.parameters, readers.episode, readers.state
    load_memory, load_flags, load_numbers = readers.memory, readers.flags, readers.numbers
    size = action_size(composition)
    load_actions, saturated = make_load_rows(layout.lanes, size), make_saturated(size)
    store_state, store_memory, store_parameters = writers.state, writers.memory, writers.parameters
    store_episode, store_outcome = writers.episode, writers.outcome
    renew_vehicle = make_renew_vehicle(layout.pool, layout.lanes)
    control_period = make_control_period(composition, task)
    begin_one = make_begin_one(composition, task, layout.time_varying)
    time_at = make_time(layout, load_numbers)
    draw_uniforms = make_lane_uniforms(composition.water.draws, task.sensing.later_draws)
    keep_water = store_parameters if composition.water.draws else keep_nothing
    keep_end = keep_ends if renewal is renew_at_same_step else keep_no_ends

    def period_blocks(
        first: int,
        last: int,
        arrays: PeriodArrays,
        actions: Any,
        period: float,
        steps: int,
        most_periods: float,
    ) -> None:
        for block in range(first, last):
            parameters = load_parameters(arrays.shared, arrays.parameters, block)
            episode = load_episode(arrays.shared_episode, arrays.episodes, block)
            state = load_state(arrays.shared, arrays.states, block)
            memory = load_memory(arrays.shared, arrays.memories, block)
            action = saturated(load_actions(actions, block))
            elapsed = load_numbers(arrays.periods, block)
            time = time_at(arrays.clocks, block, elapsed * period)
            idle = load_flags(arrays.ended, block)
            bodies = lane_numbers(elapsed, block)
            uniforms = draw_uniforms(negation(idle), arrays.generators, bodies, elapsed)
            outcome = control_period(parameters, episode, state, memory, action, time, steps, uniforms)
            step, result = outcome.step, outcome.task
            keep_water(arrays.parameters, block, in_water(parameters, outcome.water))

            terminated = (result.terminated != 0.0) & negation(idle)
            elapsed = elapsed + 1.0
            truncated = (elapsed >= most_periods) & negation(idle)
            ended = terminated | truncated
            renewed, waiting = renewal(idle, ended)
            store_rows(arrays.rewards, block, select(idle, 0.0, result.reward))
            store_rows(arrays.terminated, block, terminated)
            store_rows(arrays.truncated, block, truncated)
            store_rows(arrays.ended, block, waiting)
            store_rows(arrays.periods, block, select(renewed, 0.0, elapsed))
            velocity = outcome.motion.velocity
            spin, speed = dot(velocity.angular, velocity.angular), dot(velocity.linear, velocity.linear)
            report = (step.status, step.completed, step.fallbacks, step.residual_squared, spin, speed)
            store_outcome(arrays.outcomes, block, select(idle, (ACCEPTED, 0, 0, 0.0, 0.0, 0.0), report))

            begun = Beginning(
                outcome.water,
                spread(outcome.current_ned, result.reward),
                step.state,
                outcome.memory,
                outcome.observation,
                result.report,
            )
            keep_end(arrays, block, ended, begun)
            if some(renewed):
                default_episode = load_episode(arrays.shared_episode, arrays.default_episodes, block)
                parameters, default_episode = renew_vehicle(
                    renewed, arrays, block, bodies, parameters, default_episode
                )
                arguments = (
                    arrays.generators,
                    arrays.clocks,
                    arrays.chosen,
                    arrays.currents,
                    bodies,
                    parameters,
                    default_episode,
                )
                begun = select_call(renewed, begin_one, arguments, begun)
                store_parameters(arrays.parameters, block, in_water(parameters, begun.water))
                store_episode(arrays.episodes, block, select(renewed, default_episode, episode))
            store_state(arrays.states, block, begun.state)
            store_memory(arrays.memories, block, begun.memory)
            store_rows(arrays.observations, block, begun.observation)
            store_columns(arrays.reports, block, (begun.report, begun.current_ned))

    return compile_function(period_blocks, layout.key, apart=(composition.fallback,))


class _Readers:
    """Readers of a layout, for compiled code."""

    def __init__(self, layout: PeriodLayout) -> None:
        self.parameters = make_load_block(layout.parameters)
        self.episode = make_load_block(layout.episode)
        self.state = make_load_block(layout.state)
        self.memory = make_load_block(layout.memory)
        self.flags = make_load_column(layout.lanes.of(types.boolean))
        self.numbers = make_load_column(layout.lanes)


class _Writers:
    """Writers of a layout, for compiled code."""

    def __init__(self, layout: PeriodLayout) -> None:
        self.parameters = make_store_block(layout.parameters)
        self.episode = make_store_block(layout.episode)
        self.state = make_store_block(layout.state)
        self.memory = make_store_block(layout.memory)
        self.outcome = make_store_block(layout.outcome)
