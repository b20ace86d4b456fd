"""What a task of a moving body is: plain functions, and named tuples of numbers.

A task says how an episode starts, what is remembered from one control period to the next, what the agent observes, what
is measured, and what earns rewards, ends the episode and counts as success. All functions take the task's parameters
first, a named tuple of numbers that hold for one episode, and return numbers or tuples of them. They run in plain
Python, compiled for one body, and compiled for many bodies in SIMD lanes. Conditions are therefore written with `&`,
`|` and the functions of `algebra.selection`; only `start` and `initial_memory` may ask `if`, as they are called for
one body at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.body import Motion


class Start(NamedTuple):
    """Where an episode begins: position [m], attitude body to NED, velocity over ground in the body frame."""

    position_ned: Vector3
    attitude: Quaternion
    velocity: Spatial


class Situation(NamedTuple):
    """The end of a control period, as rewards, success and the end of an episode depend on it.

    Attributes:
        motion: the true one, whatever sensors say.
        memory: the task's, updated for this period.
        metrics: what the task measures.
        action_squares: sum of the squares of the agent's action, each number within -1 and 1.
        actions: how many numbers an action has.
    """

    motion: Motion
    memory: Any
    metrics: Any
    action_squares: float
    actions: float


def no_errors(parameters: Any, memory: Any, motion: Motion, uniforms: Any) -> Any:
    """Return the memory of a task without instruments of its own."""
    return memory


@dataclass(frozen=True)
class Task:
    """The functions of a task.

    Attributes:
        draws: how many uniform random numbers in [0, 1) an episode takes for its start and its first memory.
        start: (parameters, uniforms) -> Start.
        initial_memory: (parameters, start, uniforms) -> memory at the start of an episode.
        update_memory: (parameters, memory, motion, measured) -> memory at the end of a control period. `motion` is the
            true one and `measured` what sensors say of it; without sensors they are the same.
        observe: (parameters, memory, measured) -> nested tuples of numbers, flattened into the observation.
        metrics: the named tuple that `measure` returns; its fields are the names of the metrics.
        measure: (parameters, memory, motion) -> metrics.
        rewards: the named tuple that `reward` returns; its fields are the names of the reward's terms.
        reward: (parameters, weights, situation) -> terms, each with its weight; their sum is the reward.
        terminated: (parameters, situation) -> whether the episode ends here.
        succeeded: (parameters, situation) -> whether the task counts as done, or as being done, now.
        sense: (parameters, memory, motion, uniforms) -> memory with the errors of the task's own instruments, such as
            beams, drawn anew: after the first memory, and in each control period before `update_memory`.
        sense_draws: how many uniform random numbers in [0, 1) that takes.
    """

    draws: int
    start: Callable[[Any, tuple[float, ...]], Start]
    initial_memory: Callable[[Any, Start, tuple[float, ...]], Any]
    update_memory: Callable[[Any, Any, Motion, Motion], Any]
    observe: Callable[[Any, Any, Motion], Any]
    metrics: type[Any]
    measure: Callable[[Any, Any, Motion], Any]
    rewards: type[Any]
    reward: Callable[[Any, Any, Situation], Any]
    terminated: Callable[[Any, Situation], Any]
    succeeded: Callable[[Any, Situation], Any]
    sense: Callable[[Any, Any, Motion, Any], Any] = no_errors
    sense_draws: int = 0


class RewardTerm(NamedTuple):
    """A term that someone adds to the reward of a task.

    Attributes:
        name: what it is called in `info["reward/<name>"]`.
        function: (situation) -> number, a plain function that is compiled with the task's own.
        weight: what the number is multiplied with.
    """

    name: str
    function: Callable[[Situation], float]
    weight: float = 1.0


def no_memory(parameters: Any, start: Start, uniforms: tuple[float, ...]) -> tuple[()]:
    """Return the memory of a task that remembers nothing."""
    return ()


def same_memory(parameters: Any, memory: Any, motion: Motion, measured: Motion) -> Any:
    """Return the memory as it is."""
    return memory


def never(parameters: Any, situation: Situation) -> bool:
    """Return that this does not happen: an episode without an end of its own, or a task without success."""
    return situation.action_squares < 0.0
