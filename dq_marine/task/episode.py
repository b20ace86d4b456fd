"""A task as an episode runs it: with the vehicle's limits, the weights of its reward, and sensors besides."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dq_marine.algebra.selection import select, spread
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import Motion
from dq_marine.task.protocol import Situation, Start, Task


class EpisodeParameters(NamedTuple):
    """All numbers that an episode's formulas take, the step's apart.

    Attributes:
        task: the task's own parameters.
        weights: of the terms of its reward.
        extra_weights: of the terms that were added to it.
        wrench_limits: wrench at full action [N, N m], Fossen's order.
        actions: how many numbers the agent's action has.
        sensors: their numbers, nested in pairs; see `task.sensors.observing`.
        vehicle: in what the vehicle is not the nominal one, where that is revealed; see `task.privileged`.
    """

    task: Any
    weights: Any
    extra_weights: tuple[float, ...]
    wrench_limits: tuple[float, float, float, float, float, float]
    actions: float
    sensors: Any
    vehicle: tuple[float, ...] = ()


class Report(NamedTuple):
    """What is worth telling of the end of a control period.

    Attributes:
        metrics: what the task measures.
        rewards: the terms of the reward, each with its weight: the task's own, and those that were added.
        success: 1.0 where the task counts as done, else 0.0.
    """

    metrics: Any
    rewards: Any
    success: float


class TaskOutcome(NamedTuple):
    """The reward of a control period, 1.0 if the episode ends with it, else 0.0, and what is told of it."""

    reward: float
    terminated: float
    report: Report


class Sensing(NamedTuple):
    """What sensors do; both functions are (parameters, memory, motion, uniforms) -> memory.

    Attributes:
        first: what they read at an episode's start.
        first_draws: how many uniform random numbers in [0, 1) that takes.
        later: what they read at the end of a control period.
        later_draws: how many that takes.
    """

    first: Callable[[Any, Any, Motion, Any], Any]
    first_draws: int
    later: Callable[[Any, Any, Motion, Any], Any]
    later_draws: int


def sense_nothing(parameters: EpisodeParameters, memory: Any, motion: Motion, uniforms: Any) -> Any:
    """Return the memory: there are no sensors, the agent knows the motion as it is."""
    return memory


NO_SENSORS = Sensing(sense_nothing, 0, sense_nothing, 0)


def own_sensing(task: Task) -> Sensing:
    """Return what the task's own instruments do, if it has any."""
    if not task.sense_draws:
        return NO_SENSORS
    sense = task.sense

    def sense_own(parameters: EpisodeParameters, memory: Any, motion: Motion, uniforms: Any) -> Any:
        return sense(parameters.task, memory, motion, uniforms)

    return Sensing(sense_own, task.sense_draws, sense_own, task.sense_draws)


def act_at_once(act: Callable[..., Any]) -> Callable[..., Any]:
    """Return what an action does as it is: actions are taken at once."""
    return act


def all_is_shown(parameters: Any, memory: Any, motion: Motion) -> Any:
    """Return the memory: what is observed is shown at once, so that nothing is kept to be shown."""
    return memory


def nothing_revealed(parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3) -> Any:
    """Return nothing: what only the simulator knows stays with it."""
    return ()


@dataclass(frozen=True)
class EpisodeTask:
    """The functions that an episode runs.

    `start`, `initial_memory`, `update_memory` and `observe` take the task's own parameters, as in `task.protocol`;
    `outcome`, `reveal` and the sensors take `EpisodeParameters`.

    Attributes:
        draws: how many uniform random numbers in [0, 1) `start` and `initial_memory` take.
        start: (parameters, uniforms) -> Start.
        initial_memory: (parameters, start, uniforms) -> memory.
        update_memory: (parameters, memory, motion, measured) -> memory.
        observe: (parameters, memory, motion) -> nested tuples of numbers.
        outcome: (parameters, memory, motion, sum of the squares of the action) -> TaskOutcome.
        no_rewards: the terms of the reward, all zero.
        sensing: what sensors do to the memory.
        delay_act: (`task.action.Act`) -> the same, for actions that arrive late; see `task.delays`.
        begin_showing: (parameters, memory, motion) -> memory of an episode whose first observation is made anew.
        reveal: (parameters, memory, motion, current in NED) -> what only the simulator knows, nested tuples of numbers
            that follow those of `observe`; see `task.privileged`.
    """

    draws: int
    start: Callable[[Any, tuple[float, ...]], Start]
    initial_memory: Callable[[Any, Start, tuple[float, ...]], Any]
    update_memory: Callable[[Any, Any, Motion, Motion], Any]
    observe: Callable[[Any, Any, Motion], Any]
    outcome: Callable[[EpisodeParameters, Any, Motion, float], TaskOutcome]
    no_rewards: Any
    sensing: Sensing = NO_SENSORS
    delay_act: Callable[[Callable[..., Any]], Callable[..., Any]] = act_at_once
    begin_showing: Callable[[Any, Any, Motion], Any] = all_is_shown
    reveal: Callable[[EpisodeParameters, Any, Motion, Vector3], Any] = nothing_revealed


def wrapping(task: EpisodeTask, **functions: Any) -> EpisodeTask:
    """Return a task whose memory wraps the task's own, which it has as `task`.

    Args:
        task: that is wrapped; its outcome, and what it reveals, are those of the task's own memory.
        functions: what else is not as it was, by its name in `EpisodeTask`.
    """
    task_outcome, task_reveal = task.outcome, task.reveal

    def outcome(
        parameters: EpisodeParameters, memory: Any, motion: Motion, action_squares: float
    ) -> TaskOutcome:
        return task_outcome(parameters, memory.task, motion, action_squares)

    def reveal(parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3) -> Any:
        return task_reveal(parameters, memory.task, motion, current_ned)

    return replace(task, outcome=outcome, reveal=reveal, **functions)


def make_shown(task: EpisodeTask) -> Callable[[EpisodeParameters, Any, Motion, Vector3], Any]:
    """Return (episode's parameters, memory, motion, current in NED) -> what is observed, and what is revealed."""
    observe, reveal = task.observe, task.reveal

    def shown(parameters: EpisodeParameters, memory: Any, motion: Motion, current_ned: Vector3) -> Any:
        return (
            observe(parameters.task, memory, motion),
            reveal(parameters, memory, motion, current_ned),
        )

    return shown


def no_sum(total: float, terms: tuple[float, ...]) -> float:
    """Return the total."""
    return total


def make_sum(count: int, first: int = 0) -> Callable[[float, tuple[float, ...]], float]:
    """Return (total, tuple) -> the total plus the tuple's numbers from `first` to `count`, added from the left."""
    if first == count:
        return no_sum
    if count - first == 1:

        def add_last(total: float, terms: tuple[float, ...]) -> float:
            return total + terms[first]

        return add_last
    if count - first == 2:

        def add_two(total: float, terms: tuple[float, ...]) -> float:
            return total + terms[first] + terms[first + 1]

        return add_two

    def add_three(total: float, terms: tuple[float, ...]) -> float:
        return total + terms[first] + terms[first + 1] + terms[first + 2]

    if count - first == 3:
        return add_three
    rest = make_sum(count, first + 3)

    def add_terms(total: float, terms: tuple[float, ...]) -> float:
        return rest(add_three(total, terms), terms)

    return add_terms


def no_extras(weights: Any, situation: Situation) -> tuple[()]:
    """Return the terms that were added to the reward: none."""
    return ()


def make_extras(functions: tuple[Callable[[Situation], float], ...]) -> Callable[[Any, Situation], Any]:
    """Return (weights, situation) -> the terms that were added to the reward."""
    if not functions:
        return no_extras
    first, rest = functions[0], make_extras(functions[1:])

    def extras(weights: Any, situation: Situation) -> Any:
        return (weights[0] * first(situation), *rest(weights[1:], situation))

    return extras


def make_total(own: int, extra: int) -> Callable[[Any, Any], float]:
    """Return (terms of the task, terms added) -> the reward: their sum, added from the left."""
    add_own, add_extra = make_sum(own, 1), make_sum(extra)

    def total_of_own(terms: Any, extras: Any) -> float:
        return add_own(terms[0], terms)

    if not extra:
        return total_of_own

    def total(terms: Any, extras: Any) -> float:
        return add_extra(add_own(terms[0], terms), extras)

    return total


@functools.cache
def episode_task(task: Task, extra_rewards: tuple[Callable[[Situation], float], ...] = ()) -> EpisodeTask:
    """Return a task as an episode runs it; equal arguments give the same functions, which are compiled once.

    Args:
        task: with at least one term of reward.
        extra_rewards: functions of terms that are added to its reward.
    """
    measure, reward, ended, done = task.measure, task.reward, task.terminated, task.succeeded
    extras, total = make_extras(extra_rewards), make_total(len(task.rewards._fields), len(extra_rewards))

    def outcome(
        parameters: EpisodeParameters, memory: Any, motion: Motion, action_squares: float
    ) -> TaskOutcome:
        own = parameters.task
        metrics = measure(own, memory, motion)
        situation = Situation(motion, memory, metrics, action_squares, parameters.actions)
        terms = reward(own, parameters.weights, situation)
        added = extras(parameters.extra_weights, situation)
        like = motion.position_ned[0]
        success = select(done(own, situation), spread(1.0, like), spread(0.0, like))
        terminated = select(ended(own, situation), spread(1.0, like), spread(0.0, like))
        return TaskOutcome(total(terms, added), terminated, Report(metrics, (terms, added), success))

    none = (task.rewards(*(0.0,) * len(task.rewards._fields)), (0.0,) * len(extra_rewards))
    return EpisodeTask(
        task.draws,
        task.start,
        task.initial_memory,
        task.update_memory,
        task.observe,
        outcome,
        none,
        own_sensing(task),
    )
