"""What makes a task of a moving body: memory, observation, reward and end, as plain functions.

The functions of a task take its parameters first and return tuples of numbers, like the rest of the kernel, so
that an environment's formulas stand in one place whether they run in plain Python, compiled for one body, or in
lanes. One control period is: act, advance, sense, remember, then observe and judge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from dq_marine.kernel.body import BodyState, Motion
from dq_marine.kernel.push import action_size, make_actuators_push, make_push, make_sum_of_squares
from dq_marine.kernel.quaternion import Quaternion
from dq_marine.kernel.selection import select
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.step import (
    ACCEPTED,
    Composition,
    StepOutcome,
    StepParameters,
    in_water,
    make_motion,
)
from dq_marine.kernel.vector3 import Vector3


class Verdict(NamedTuple):
    """How good a control period's end is.

    Attributes:
        reward: of this period.
        terminated: 1.0 if the episode ends here, else 0.0.
        measures: quantities worth reporting, in the order of `Task.measure_names`.
    """

    reward: float
    terminated: float
    measures: tuple[float, ...]


class Start(NamedTuple):
    """Where an episode begins: position [m], attitude body to NED, velocity over ground in the body frame."""

    position_ned: Vector3
    attitude: Quaternion
    velocity: Spatial


def sense_nothing(aim: Any, memory: Any, motion: Motion, uniforms: Any) -> Any:
    """Return the memory: the task has no sensors, and knows the motion as it is."""
    return memory


class Sensing(NamedTuple):
    """What a task's sensors do; both functions are (parameters, memory, motion, uniforms) -> memory.

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


NO_SENSORS = Sensing(sense_nothing, 0, sense_nothing, 0)


@dataclass(frozen=True)
class Task:
    """The functions of a task.

    Attributes:
        draws: how many uniform random numbers in [0, 1) `start` takes.
        start: (parameters, uniforms) -> Start. Called for one body at a time, it may branch.
        forget: (parameters) -> memory at an episode's start.
        act: (parameters, action) -> wrench on the body, from the normalised action of six axes; not called where
            actuators drive the body.
        remember: (parameters, memory, motion) -> memory at the end of a control period.
        observe: (parameters, memory, motion) -> nested tuples of numbers, flattened into the observation.
        judge: (parameters, motion, sum of squares of the action) -> Verdict.
        measure_names: names of the verdict's measures.
        episode_fields: of the parameters, those that may differ between episodes.
        sensing: what sensors do to the memory.
    """

    draws: int
    start: Callable[[Any, tuple[float, ...]], Start]
    forget: Callable[[Any], Any]
    act: Callable[[Any, Any], Spatial]
    remember: Callable[[Any, Any, Motion], Any]
    observe: Callable[[Any, Any, Motion], Any]
    judge: Callable[[Any, Motion, float], Verdict]
    measure_names: tuple[str, ...]
    episode_fields: tuple[str, ...]
    sensing: Sensing = NO_SENSORS


class PeriodUniforms(NamedTuple):
    """Uniform random numbers in [0, 1) for one control period: for the water, and for the task's sensors."""

    water: tuple[float, ...]
    sensing: tuple[float, ...]


class PeriodOutcome(NamedTuple):
    """The end of one control period.

    After a refused step all is as before the period, but for the verdict: no reward, and the end.
    """

    step: StepOutcome
    water: Any
    memory: Any
    observation: Any
    verdict: Verdict


def no_choice(condition: bool, chosen: Any, otherwise: Any) -> Any:
    """Return `chosen`, from which `otherwise` does not differ."""
    return chosen


def draws_of_period(composition: Composition, task: Task) -> PeriodUniforms:
    """Return zeros for the uniform random numbers that a control period takes."""
    return PeriodUniforms((0.0,) * composition.water.draws, (0.0,) * task.sensing.later_draws)


def make_control_period(
    composition: Composition, task: Task
) -> Callable[[StepParameters, Any, BodyState, Any, Any, float, int, PeriodUniforms], PeriodOutcome]:
    """Return (parameters, task parameters, state, memory, action, time, steps, uniforms) -> outcome.

    Where the composition has actuators, the task must be made by `with_actuators`.
    """
    push = (
        make_actuators_push(composition) if composition.actuation.channels else make_push(composition, task)
    )
    motion_of, sum_of_squares = make_motion(composition), make_sum_of_squares(action_size(composition))
    sense, remember, observe, judge = task.sensing.later, task.remember, task.observe, task.judge
    evolve, choose_water = composition.water.evolve, select if composition.water.draws else no_choice

    def control_period(
        parameters: StepParameters,
        aim: Any,
        state: BodyState,
        memory: Any,
        action: Any,
        time: float,
        steps: int,
        uniforms: PeriodUniforms,
    ) -> PeriodOutcome:
        moving = evolve(parameters.water, time, uniforms.water)
        step, pushed = push(in_water(parameters, moving), aim, state, memory, action, time, steps)
        taken = step.status == ACCEPTED
        water = choose_water(taken, moving, parameters.water)
        motion = motion_of(in_water(parameters, water), step.state)
        sensed = sense(aim, pushed, motion, uniforms.sensing)
        memory_after = select(taken, remember(aim, sensed, motion), memory)
        verdict = judge(aim, motion, sum_of_squares(action))
        reward = select(taken, verdict.reward, 0.0)
        terminated = select(taken, verdict.terminated, 1.0)
        return PeriodOutcome(
            step,
            water,
            memory_after,
            observe(aim, memory_after, motion),
            Verdict(reward, terminated, verdict.measures),
        )

    return control_period
