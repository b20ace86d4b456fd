"""How an action moves the body for one control period: as a wrench on it, or as commands of its actuators.

An action is a flat tuple of numbers in [-1, 1]: six, for the axes, or one for every channel of the actuators.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from dq_marine.kernel.actuated import actuators_reader, make_actuated_advance
from dq_marine.kernel.actuation import NO_WRENCH
from dq_marine.kernel.body import BodyState
from dq_marine.kernel.step import Composition, StepOutcome, StepParameters, make_advance
from dq_marine.kernel.vector3 import dot

if TYPE_CHECKING:
    from dq_marine.kernel.task import Task

AXES = 6
"""Numbers in an action that is a wrench."""

Push: TypeAlias = Callable[
    [StepParameters, Any, BodyState, Any, tuple[float, ...], float, int], tuple[StepOutcome, Any]
]
"""(parameters, task parameters, state, memory, action, time, steps) -> (outcome, memory)."""


class ActuatedMemory(NamedTuple):
    """The memory of a task whose body is driven by actuators: the task's own, and the channels' values, nested."""

    task: Any
    values: Any


def action_size(composition: Composition) -> int:
    """Return how many numbers an action has."""
    return composition.actuation.channels or AXES


def make_push(composition: Composition, task: Task) -> Push:
    """Return the push by the wrench that the task makes of an action."""
    advance, act = make_advance(composition), task.act

    def push(
        parameters: StepParameters,
        aim: Any,
        state: BodyState,
        memory: Any,
        action: tuple[float, ...],
        time: float,
        steps: int,
    ) -> tuple[StepOutcome, Any]:
        return advance(parameters, state, act(aim, action), time, steps), memory

    return push


def make_actuators_push(composition: Composition) -> Push:
    """Return the push by actuators, whose channels' values stand in an `ActuatedMemory`."""
    advance, read = make_actuated_advance(composition), actuators_reader(composition)
    nest, commands = composition.actuation.nest, composition.actuation.commands

    def push_by_actuators(
        parameters: StepParameters,
        aim: Any,
        state: BodyState,
        memory: ActuatedMemory,
        action: tuple[float, ...],
        time: float,
        steps: int,
    ) -> tuple[StepOutcome, ActuatedMemory]:
        commanded = commands(read(parameters).channels, nest(action))
        outcome = advance(parameters, state, memory.values, commanded, NO_WRENCH, time, steps)
        return outcome.step, ActuatedMemory(memory.task, outcome.values)

    return push_by_actuators


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
