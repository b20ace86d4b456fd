"""A task whose agent is told what sensors read: observed and remembered is the measured motion, judged the true one."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.nesting import nested
from dq_marine.integrator.body import Motion
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, Sensing, wrapping
from dq_marine.task.protocol import Start
from dq_marine.task.sensors.errors import (
    Instrument,
    Reading,
    first_draws,
    later_draws,
    make_first_reading,
    make_later_reading,
)

OLDEST = 60.0
"""Ages of readings are told up to this [s]."""

Instruments = tuple[Instrument, ...]


class Sensed(NamedTuple):
    """The task's own memory, and the readings, nested in pairs (first, (second, (..., ())))."""

    task: Any
    readings: Any


def blank_readings(instruments: Instruments) -> Any:
    """Return readings of zeros."""
    zero = (0.0, 0.0, 0.0)
    blanks = [instrument.blank for instrument in instruments]
    return nested([Reading(values, zero, zero, 0.0, 0.0, carried) for values, carried in blanks])


def no_first(numbers: Any, motion: Motion, uniforms: Any) -> tuple[()]:
    """Return no readings."""
    return ()


def no_later(numbers: Any, readings: Any, motion: Motion, uniforms: Any) -> tuple[()]:
    """Return no readings."""
    return ()


def believe_truth(readings: Any, motion: Motion) -> Motion:
    """Return the motion as it is."""
    return motion


def show_nothing(readings: Any) -> tuple[()]:
    """Return nothing to be observed."""
    return ()


def join_first(instruments: Instruments) -> Callable[[Any, Motion, Any], Any]:
    """Return (sensors' numbers, motion, uniforms) -> readings at an episode's start."""
    if not instruments:
        return no_first
    first_reading, rest = make_first_reading(instruments[0]), join_first(instruments[1:])
    own = first_draws(instruments[0])

    def read_first(numbers: Any, motion: Motion, uniforms: Any) -> Any:
        return (
            first_reading(numbers[0], motion, uniforms[:own]),
            rest(numbers[1], motion, uniforms[own:]),
        )

    return read_first


def join_later(instruments: Instruments) -> Callable[[Any, Any, Motion, Any], Any]:
    """Return (sensors' numbers, readings, motion, uniforms) -> readings at the end of the next control period."""
    if not instruments:
        return no_later
    later_reading, rest = make_later_reading(instruments[0]), join_later(instruments[1:])
    own = later_draws(instruments[0])

    def read_later(numbers: Any, readings: Any, motion: Motion, uniforms: Any) -> Any:
        return (
            later_reading(numbers[0], readings[0], motion, uniforms[:own]),
            rest(numbers[1], readings[1], motion, uniforms[own:]),
        )

    return read_later


def join_believe(instruments: Instruments) -> Callable[[Any, Motion], Motion]:
    """Return (readings, motion) -> the motion with what is measured in place of what is true."""
    if not instruments:
        return believe_truth
    believe, rest = instruments[0].believe, join_believe(instruments[1:])

    def believe_all(readings: Any, motion: Motion) -> Motion:
        return rest(readings[1], believe(readings[0].values, motion))

    return believe_all


def join_show(instruments: Instruments) -> Callable[[Any], Any]:
    """Return (readings) -> each sensor's age, and what else it shows."""
    if not instruments:
        return show_nothing
    show, rest = instruments[0].show, join_show(instruments[1:])

    def show_all(readings: Any) -> Any:
        return ((min(readings[0].age, OLDEST), show(readings[0].values)), rest(readings[1]))

    return show_all


@functools.cache
def with_sensors(task: EpisodeTask, instruments: Instruments) -> EpisodeTask:
    """Return the task told by sensors, whose numbers its parameters hold in `sensors`."""
    read_first, read_later = join_first(instruments), join_later(instruments)
    believe, show = join_believe(instruments), join_show(instruments)
    first_memory, next_memory = task.initial_memory, task.update_memory
    observe_task = task.observe
    blank, own_first, own_later = blank_readings(instruments), task.sensing.first, task.sensing.later
    begin, proceed = task.sensing.first_draws, task.sensing.later_draws

    def initial_memory(parameters: Any, begun: Start, uniforms: tuple[float, ...]) -> Sensed:
        return Sensed(first_memory(parameters, begun, uniforms), blank)

    def first(parameters: EpisodeParameters, memory: Sensed, motion: Motion, uniforms: Any) -> Sensed:
        sensed = own_first(parameters, memory.task, motion, uniforms[:begin])
        return Sensed(sensed, read_first(parameters.sensors, motion, uniforms[begin:]))

    def later(parameters: EpisodeParameters, memory: Sensed, motion: Motion, uniforms: Any) -> Sensed:
        sensed = own_later(parameters, memory.task, motion, uniforms[:proceed])
        read = read_later(parameters.sensors, memory.readings, motion, uniforms[proceed:])
        return Sensed(sensed, read)

    def update_memory(parameters: Any, memory: Sensed, motion: Motion, measured: Motion) -> Sensed:
        told = believe(memory.readings, measured)
        return Sensed(next_memory(parameters, memory.task, motion, told), memory.readings)

    def observe(parameters: Any, memory: Sensed, motion: Motion) -> Any:
        told = believe(memory.readings, motion)
        return (observe_task(parameters, memory.task, told), show(memory.readings))

    sensing = Sensing(
        first,
        begin + sum(map(first_draws, instruments)),
        later,
        proceed + sum(map(later_draws, instruments)),
    )
    return wrapping(
        task,
        initial_memory=initial_memory,
        update_memory=update_memory,
        observe=observe,
        sensing=sensing,
    )
