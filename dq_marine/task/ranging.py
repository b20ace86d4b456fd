"""A task whose range sensor pings now and then, all its beams at once or in turns, and tells late what came back.

What the agent is shown is held from ping to ping, with the age of each. Pings and what is late are counted in control
periods, and one ping at a time is under way. All of it is part of the memory: it is saved and copied with the episode.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.selection import select
from dq_marine.algebra.stages import for_each
from dq_marine.integrator.body import Motion
from dq_marine.task.common import next_turn
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, wrapping
from dq_marine.task.protocol import Start
from dq_marine.task.sensors.observing import OLDEST


class Schedule(NamedTuple):
    """When a range sensor pings and tells; times are in control periods.

    Attributes:
        beams: how many it has.
        turns: pings of a sweep, each with the next share of the beams: 1 where all ping at once.
        interval: from ping to ping, 1 or more.
        latency: from a ping until what came back is told, at most the interval.
        period: control period [s].
    """

    beams: int
    turns: int
    interval: int
    latency: int
    period: float


class Ranged(NamedTuple):
    """The memory of a task with a schedule of pings.

    Attributes:
        told: readings that the agent is shown, one for each beam.
        ages: of them, one for each turn [s].
        coming: readings at the last ping, where they are told late.
        since: control periods since that.
        turn: whose beams it was.
        task: the task's own memory.
    """

    told: Any
    ages: Any
    coming: Any
    since: float
    turn: float
    task: Any


class Telling(NamedTuple):
    """How the readings of a ping become known.

    Attributes:
        coming: (fresh readings) -> those that are under way.
        told: (memory, periods since the last ping, fresh readings, whether there is one now, whose turn it is) -> told,
            ages, coming.
    """

    coming: Callable[[Any], Any]
    told: Callable[[Ranged, float, Any, Any, float], Any]


def make_taken(turns: int, width: int, first: int = 0) -> Callable[[Any, float, Any, Any], Any]:
    """Return (condition, turn, new, old) -> the old numbers, with the new ones of that turn where the condition holds.

    Each turn has `width` numbers, those of the first turn first.
    """
    begin, end = first * width, (first + 1) * width

    def one(condition: Any, turn: float, new: Any, old: Any) -> Any:
        mine = condition & (turn > first - 0.5) & (turn < first + 0.5)
        return select(mine, new[begin:end], old[begin:end])

    if first == turns - 1:
        return one
    rest = make_taken(turns, width, first + 1)

    def taken(condition: Any, turn: float, new: Any, old: Any) -> Any:
        return (*one(condition, turn, new, old), *rest(condition, turn, new, old))

    return taken


def older(age: float, time: float) -> float:
    """Return an age some time later [s]."""
    return min(OLDEST, age + time)


def under_way(fresh: Any) -> Any:
    """Return the readings, which are told later."""
    return fresh


def none_under_way(fresh: Any) -> tuple[()]:
    """Return no readings: they are told at once."""
    return ()


def make_telling(schedule: Schedule) -> Telling:
    """Return how the readings of a ping become known, at once or late."""
    beams, turns, _, latency, period = schedule
    take_readings, take_ages = make_taken(turns, beams // turns), make_taken(turns, 1)
    late = (latency * period,) * turns

    def at_once(memory: Ranged, since: float, fresh: Any, pings: Any, turn: float) -> Any:
        ages = for_each(memory.ages, older, period)
        return take_readings(pings, turn, fresh, memory.told), take_ages(pings, turn, late, ages), ()

    def later(memory: Ranged, since: float, fresh: Any, pings: Any, turn: float) -> Any:
        arrives = (since > latency - 0.5) & (since < latency + 0.5)
        ages = for_each(memory.ages, older, period)
        return (
            take_readings(arrives, memory.turn, memory.coming, memory.told),
            take_ages(arrives, memory.turn, late, ages),
            select(pings, fresh, memory.coming),
        )

    return Telling(under_way, later) if latency else Telling(none_under_way, at_once)


@functools.cache
def with_schedule(task: EpisodeTask, schedule: Schedule) -> EpisodeTask:
    """Return a task whose range sensor follows a schedule; the ages of readings join what is observed.

    An episode begins as if all beams had just told of a ping.

    Args:
        task: whose sensing draws the errors of readings, and whose `observe` returns these first, a tuple of them.
        schedule: of the pings.
    """
    telling, turns = make_telling(schedule), schedule.turns
    due, last = schedule.interval - 0.5, turns - 1.0
    start_coming, tell = telling.coming, telling.told
    first_memory, next_memory, observe_task = task.initial_memory, task.update_memory, task.observe
    first_reading, later_reading = task.sensing.first, task.sensing.later
    nothing, new = (0.0,) * schedule.beams, (0.0,) * turns
    nothing_coming = start_coming(nothing)

    def initial_memory(parameters: Any, begun: Start, uniforms: tuple[float, ...]) -> Ranged:
        return Ranged(nothing, new, nothing_coming, 0.0, last, first_memory(parameters, begun, uniforms))

    def first(parameters: EpisodeParameters, memory: Ranged, motion: Motion, uniforms: Any) -> Ranged:
        sensed = first_reading(parameters, memory.task, motion, uniforms)
        fresh = observe_task(parameters.task, sensed, motion)[0]
        return Ranged(fresh, memory.ages, start_coming(fresh), memory.since, memory.turn, sensed)

    def later(parameters: EpisodeParameters, memory: Ranged, motion: Motion, uniforms: Any) -> Ranged:
        sensed = later_reading(parameters, memory.task, motion, uniforms)
        return Ranged(memory.told, memory.ages, memory.coming, memory.since, memory.turn, sensed)

    def update_memory(parameters: Any, memory: Ranged, motion: Motion, measured: Motion) -> Ranged:
        updated = next_memory(parameters, memory.task, motion, measured)
        fresh = observe_task(parameters, updated, measured)[0]
        since = memory.since + 1.0
        pings = since > due
        turn = select(pings, next_turn(memory.turn, turns), memory.turn)
        told, ages, coming = tell(memory, since, fresh, pings, turn)
        return Ranged(told, ages, coming, select(pings, 0.0, since), turn, updated)

    def observe(parameters: Any, memory: Ranged, motion: Motion) -> Any:
        observed = observe_task(parameters, memory.task, motion)
        return ((memory.told, *observed[1:]), memory.ages)

    return wrapping(
        task,
        initial_memory=initial_memory,
        update_memory=update_memory,
        observe=observe,
        sensing=task.sensing._replace(first=first, later=later),
    )
