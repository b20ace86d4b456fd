"""How an action moves the body for one control period: as a wrench on it, or as commands of its actuators.

An action is a flat tuple of numbers in [-1, 1]: six, for the axes, or one for every channel of the actuators.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.spatial import Spatial, from_fossen
from dq_marine.algebra.vector3 import bounded, bounded_vector, dot
from dq_marine.integrator.actuation import NO_WRENCH
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.step import Composition, StepOutcome, StepParameters, make_advance
from dq_marine.physics.actuators.formulas.stepping import actuators_reader, make_actuated_advance
from dq_marine.task.episode import EpisodeParameters

AXES = 6
"""Numbers in an action that is a wrench."""

Act: TypeAlias = Callable[
    [StepParameters, EpisodeParameters, BodyState, Any, tuple[float, ...], float, int],
    tuple[StepOutcome, Any],
]
"""(step's parameters, episode's parameters, state, memory, action, time, steps) -> (outcome, memory)."""


class ActuatedMemory(NamedTuple):
    """The memory of a task whose body is driven by actuators: the task's own, and the channels' values, nested."""

    task: Any
    values: Any


def action_size(composition: Composition) -> int:
    """Return how many numbers an action has."""
    return composition.actuation.channels or AXES


def wrench_of(episode: EpisodeParameters, action: tuple[float, ...]) -> Spatial:
    """Return the body wrench of a normalised action of six axes."""
    limits = episode.wrench_limits
    return from_fossen(
        (
            limits[0] * action[0],
            limits[1] * action[1],
            limits[2] * action[2],
            limits[3] * action[3],
            limits[4] * action[4],
            limits[5] * action[5],
        )
    )


def make_wrench_action(composition: Composition) -> Act:
    """Return what an action does where it means a wrench."""
    advance = make_advance(composition)

    def act(
        parameters: StepParameters,
        episode: EpisodeParameters,
        state: BodyState,
        memory: Any,
        action: tuple[float, ...],
        time: float,
        steps: int,
    ) -> tuple[StepOutcome, Any]:
        return advance(parameters, state, wrench_of(episode, action), time, steps), memory

    return act


def make_actuator_action(composition: Composition) -> Act:
    """Return what an action does where actuators take it, whose channels' values stand in an `ActuatedMemory`."""
    advance, read = make_actuated_advance(composition), actuators_reader(composition)
    nest, commands = composition.actuation.nest, composition.actuation.commands

    def act_by_actuators(
        parameters: StepParameters,
        episode: EpisodeParameters,
        state: BodyState,
        memory: ActuatedMemory,
        action: tuple[float, ...],
        time: float,
        steps: int,
    ) -> tuple[StepOutcome, ActuatedMemory]:
        commanded = commands(read(parameters).channels, nest(action))
        outcome = advance(parameters, state, memory.values, commanded, NO_WRENCH, time, steps)
        return outcome.step, ActuatedMemory(memory.task, outcome.values)

    return act_by_actuators


def make_sum_of_squares(size: int, first: int = 0) -> Callable[[tuple[float, ...]], float]:
    """Return (action) -> the sum of the squares of its numbers from `first` to `size`, summed by threes."""
    if size - first == 1:

        def square(action: tuple[float, ...]) -> float:
            return action[first] * action[first]

        return square
    if size - first == 2:

        def two_squares(action: tuple[float, ...]) -> float:
            return action[first] * action[first] + action[first + 1] * action[first + 1]

        return two_squares

    def three_squares(action: tuple[float, ...]) -> float:
        three = (action[first], action[first + 1], action[first + 2])
        return dot(three, three)

    if size - first == 3:
        return three_squares
    rest = make_sum_of_squares(size, first + 3)

    def squares(action: tuple[float, ...]) -> float:
        return three_squares(action) + rest(action)

    return squares


def make_saturated(size: int, first: int = 0) -> Callable[[Any], Any]:
    """Return (action) -> its numbers from `first` to `size`, each held within -1 and 1."""
    if size - first == 1:

        def saturated_last(action: Any) -> Any:
            return (bounded(action[first], 1.0),)

        return saturated_last
    if size - first == 2:

        def saturated_two(action: Any) -> Any:
            return (bounded(action[first], 1.0), bounded(action[first + 1], 1.0))

        return saturated_two

    def saturated_three(action: Any) -> Any:
        return bounded_vector((action[first], action[first + 1], action[first + 2]), 1.0)

    if size - first == 3:
        return saturated_three
    rest = make_saturated(size, first + 3)

    def saturated(action: Any) -> Any:
        return (*saturated_three(action), *rest(action))

    return saturated
