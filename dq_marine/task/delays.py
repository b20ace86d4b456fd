"""A task whose vehicle takes actions late, and whose agent is shown late what it observes.

Both are counted in control periods. What is under way is part of the memory: it is saved and copied with the episode,
and the next episode begins with nothing under way.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.integrator.body import BodyState, Motion
from dq_marine.integrator.step import StepOutcome, StepParameters
from dq_marine.task.action import Act
from dq_marine.task.episode import EpisodeParameters, EpisodeTask, wrapping
from dq_marine.task.protocol import Start


class Delays(NamedTuple):
    """How late actions are taken, and observations shown, in control periods."""

    action: int
    observation: int


class Delayed(NamedTuple):
    """The memory of a task with delays.

    Attributes:
        actions: on their way to the vehicle, the one that is taken next first.
        observations: on their way to the agent: the one that it is shown now, and those after it.
        task: the memory of the task; last, as that of actuators ends with what they have reached.
    """

    actions: Any
    observations: Any
    task: Any


class Queue(NamedTuple):
    """How items wait.

    Attributes:
        filled: (item) -> items, as many as wait, all alike.
        pushed: (items, newest) -> items without the first, with the newest at the end.
        first: (items, newest) -> the first of them, or the newest where none waits.
    """

    filled: Callable[[Any], Any]
    pushed: Callable[[Any, Any], Any]
    first: Callable[[Any, Any], Any]


def none_waiting(item: Any) -> tuple[()]:
    """Return no items."""
    return ()


def still_none(items: Any, newest: Any) -> tuple[()]:
    """Return no items."""
    return ()


def newest_first(items: Any, newest: Any) -> Any:
    """Return the newest: nothing waits before it."""
    return newest


def pushed(items: Any, newest: Any) -> Any:
    """Return the items without the first, with the newest at the end."""
    return (*items[1:], newest)


def first_waiting(items: Any, newest: Any) -> Any:
    """Return the item that has waited longest."""
    return items[0]


def make_filled(count: int) -> Callable[[Any], Any]:
    """Return (item) -> a tuple that has it so many times."""
    if count == 1:

        def once(item: Any) -> Any:
            return (item,)

        return once
    rest = make_filled(count - 1)

    def filled(item: Any) -> Any:
        return (item, *rest(item))

    return filled


def make_queue(count: int) -> Queue:
    """Return how so many items wait."""
    if count == 0:
        return Queue(none_waiting, still_none, newest_first)
    return Queue(make_filled(count), pushed, first_waiting)


@functools.cache
def with_delays(task: EpisodeTask, delays: Delays, action_size: int, blank_observation: Any) -> EpisodeTask:
    """Return the task with delays, of which at least one is not 0.

    Until the first action arrives the vehicle is driven by none, an action of zeros; until there is an older
    observation, the episode's first one is shown.

    Args:
        task: made for the composition's actuators, if it has any.
        delays: of actions and observations.
        action_size: how many numbers an action has.
        blank_observation: what the task observes, with zeros for the numbers.
    """
    actions = make_queue(delays.action)
    observations = make_queue(delays.observation + 1 if delays.observation else 0)
    fill, push, oldest = observations.filled, observations.pushed, observations.first
    push_action, next_action = actions.pushed, actions.first
    still = actions.filled((0.0,) * action_size)
    nothing_shown = fill(blank_observation)
    first_memory, next_memory, observe_task = task.initial_memory, task.update_memory, task.observe
    delay_within = task.delay_act
    first_reading, later_reading = task.sensing.first, task.sensing.later

    def initial_memory(parameters: Any, begun: Start, uniforms: tuple[float, ...]) -> Delayed:
        return Delayed(still, nothing_shown, first_memory(parameters, begun, uniforms))

    def begin_showing(parameters: Any, memory: Delayed, motion: Motion) -> Delayed:
        seen = observe_task(parameters, memory.task, motion)
        return Delayed(memory.actions, fill(seen), memory.task)

    def first(parameters: EpisodeParameters, memory: Delayed, motion: Motion, uniforms: Any) -> Delayed:
        sensed = first_reading(parameters, memory.task, motion, uniforms)
        return begin_showing(parameters.task, Delayed(memory.actions, memory.observations, sensed), motion)

    def later(parameters: EpisodeParameters, memory: Delayed, motion: Motion, uniforms: Any) -> Delayed:
        sensed = later_reading(parameters, memory.task, motion, uniforms)
        return Delayed(memory.actions, memory.observations, sensed)

    def update_memory(parameters: Any, memory: Delayed, motion: Motion, measured: Motion) -> Delayed:
        updated = next_memory(parameters, memory.task, motion, measured)
        seen = observe_task(parameters, updated, motion)
        return Delayed(memory.actions, push(memory.observations, seen), updated)

    def observe(parameters: Any, memory: Delayed, motion: Motion) -> Any:
        return oldest(memory.observations, observe_task(parameters, memory.task, motion))

    def delay_act(act: Act) -> Act:
        act_at_once = delay_within(act)

        def act_late(
            parameters: StepParameters,
            episode: EpisodeParameters,
            state: BodyState,
            memory: Delayed,
            action: tuple[float, ...],
            time: float,
            steps: int,
        ) -> tuple[StepOutcome, Delayed]:
            taken = next_action(memory.actions, action)
            outcome, acted = act_at_once(parameters, episode, state, memory.task, taken, time, steps)
            return outcome, Delayed(push_action(memory.actions, action), memory.observations, acted)

        return act_late

    return wrapping(
        task,
        initial_memory=initial_memory,
        update_memory=update_memory,
        observe=observe,
        sensing=task.sensing._replace(first=first, later=later),
        delay_act=delay_act,
        begin_showing=begin_showing,
    )
