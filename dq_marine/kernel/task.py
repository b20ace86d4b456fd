"""What makes a task of a moving body: memory, observation, reward and end, as plain functions.

The functions of a task take its parameters first and return tuples of numbers, like the rest of the kernel, so
that an environment's formulas stand in one place whether they run in plain Python, compiled for one body, or in
lanes. One control period is: act, advance, remember, then observe and judge.
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


class PeriodOutcome(NamedTuple):
    """The end of one control period.

    After a refused step all is as before the period, but for the verdict: no reward, and the end.
    """

    step: StepOutcome
    memory: Any
    observation: Any
    verdict: Verdict


def make_control_period(
    composition: Composition, task: Task
) -> Callable[[StepParameters, Any, BodyState, Any, Any, float, int], PeriodOutcome]:
    """Return (parameters, task parameters, state, memory, action, time, steps) -> outcome: one control period.

    Where the composition has actuators, the task must be made by `with_actuators`.
    """
    push = (
        make_actuators_push(composition) if composition.actuation.channels else make_push(composition, task)
    )
    motion_of, sum_of_squares = make_motion(composition), make_sum_of_squares(action_size(composition))
    remember, observe, judge = task.remember, task.observe, task.judge

    def control_period(
        parameters: StepParameters,
        aim: Any,
        state: BodyState,
        memory: Any,
        action: Any,
        time: float,
        steps: int,
    ) -> PeriodOutcome:
        step, pushed = push(parameters, aim, state, memory, action, time, steps)
        taken = step.status == ACCEPTED
        motion = motion_of(parameters, step.state)
        memory_after = select(taken, remember(aim, pushed, motion), memory)
        verdict = judge(aim, motion, sum_of_squares(action))
        reward = select(taken, verdict.reward, 0.0)
        terminated = select(taken, verdict.terminated, 1.0)
        return PeriodOutcome(
            step,
            memory_after,
            observe(aim, memory_after, motion),
            Verdict(reward, terminated, verdict.measures),
        )

    return control_period
