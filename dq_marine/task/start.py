"""How an episode begins: drawn from random numbers, then placed and observed, by the same formulas for one and many."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.selection import spread
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import BodyState, Motion
from dq_marine.integrator.step import Composition, StepParameters, in_water, make_motion, make_placement
from dq_marine.integrator.water import CURRENT_DRAWS, CurrentDraw
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, Report, make_shown
from dq_marine.task.protocol import Start

CLOCK_SPAN = 1e4
"""Episodes in weather that changes begin at a time drawn from this many seconds: each meets another stretch of it."""


class Drawn(NamedTuple):
    """What an episode begins with.

    Attributes:
        start: position, attitude and velocity.
        current_ned: of the water [m/s].
        for_task: uniform random numbers, those that the start was drawn from.
        for_sensing: uniform random numbers for the first measurement.
    """

    start: Start
    current_ned: Vector3
    for_task: tuple[float, ...]
    for_sensing: tuple[float, ...]


class Beginning(NamedTuple):
    """A begun episode.

    Attributes:
        water: the water's parameters.
        current_ned: its velocity where the body is [m/s].
        state: of the body.
        memory: of the task.
        observation: nested tuples of numbers: what is observed, and what is revealed besides.
        report: with rewards of zero.
    """

    water: Any
    current_ned: Vector3
    state: BodyState
    memory: Any
    observation: Any
    report: Report


def beginning_draws(task: EpisodeTask) -> int:
    """Return how many uniform random numbers an episode's beginning takes."""
    return CURRENT_DRAWS + task.draws + task.sensing.first_draws


def make_draw(
    composition: Composition, task: EpisodeTask
) -> Callable[[EpisodeParameters, CurrentDraw, tuple[float, ...]], Drawn]:
    """Return (episode's parameters, current draw, uniforms) -> Drawn; there are `beginning_draws` uniforms."""
    start_of, current_of = task.start, composition.water.draw
    sensing_from = CURRENT_DRAWS + task.draws

    def draw(episode: EpisodeParameters, currents: CurrentDraw, uniforms: tuple[float, ...]) -> Drawn:
        current = current_of(currents, uniforms[0], uniforms[1])
        for_task = uniforms[CURRENT_DRAWS:sensing_from]
        return Drawn(start_of(episode.task, for_task), current, for_task, uniforms[sensing_from:])

    return draw


def make_beginning(
    composition: Composition, task: EpisodeTask
) -> Callable[[StepParameters, EpisodeParameters, Drawn], Beginning]:
    """Return (step's parameters, episode's parameters, drawn) -> Beginning."""
    flow, velocity = composition.water.flow, composition.water.velocity
    place, motion_of = make_placement(composition), make_motion(composition)
    initial_memory, sense, show = task.initial_memory, task.sensing.first, make_shown(task)
    first_report = make_first_report(task)

    def begin(parameters: StepParameters, episode: EpisodeParameters, drawn: Drawn) -> Beginning:
        start, flowing = drawn.start, in_water(parameters, flow(parameters.water, drawn.current_ned))
        state = place(flowing, start.position_ned, start.attitude, start.velocity)
        motion = motion_of(flowing, state)
        empty = initial_memory(episode.task, start, drawn.for_task)
        memory = sense(episode, empty, motion, drawn.for_sensing)
        current_ned = velocity(flowing.water, state.pose)
        return Beginning(
            flowing.water,
            current_ned,
            state,
            memory,
            show(episode, memory, motion, current_ned),
            first_report(episode, memory, motion),
        )

    return begin


def make_first_report(task: EpisodeTask) -> Callable[[EpisodeParameters, Any, Motion], Report]:
    """Return (episode's parameters, memory, motion) -> what is told where no control period has gone by."""
    outcome, no_rewards = task.outcome, task.no_rewards

    def first_report(episode: EpisodeParameters, memory: Any, motion: Motion) -> Report:
        like = motion.position_ned[0]
        report = outcome(episode, memory, motion, spread(0.0, like)).report
        return Report(report.metrics, spread(no_rewards, like), report.success)

    return first_report
