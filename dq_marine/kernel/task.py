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
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.step import Composition, StepOutcome, StepParameters, make_advance, make_motion


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


@dataclass(frozen=True)
class Task:
    """The functions of a task.

    Attributes:
        act: (parameters, action) -> wrench on the body, from the normalised action of six axes.
        remember: (parameters, memory, motion) -> memory at the end of a control period.
        observe: (parameters, memory, motion) -> nested tuples of numbers, flattened into the observation.
        judge: (parameters, motion, action) -> Verdict.
        measure_names: names of the verdict's measures.
    """

    act: Callable[[Any, Any], Spatial]
    remember: Callable[[Any, Any, Motion], Any]
    observe: Callable[[Any, Any, Motion], Any]
    judge: Callable[[Any, Motion, Any], Verdict]
    measure_names: tuple[str, ...]


class PeriodOutcome(NamedTuple):
    """The end of one control period; memory, observation and verdict mean nothing if the step was refused."""

    step: StepOutcome
    memory: Any
    observation: Any
    verdict: Verdict


def make_control_period(
    composition: Composition, task: Task
) -> Callable[[StepParameters, Any, BodyState, Any, Any, float, int], PeriodOutcome]:
    """Return (parameters, task parameters, state, memory, action, time, steps) -> outcome: one control period."""
    advance = make_advance(composition)
    motion_of = make_motion(composition)
    act, remember, observe, judge = task.act, task.remember, task.observe, task.judge

    def control_period(
        parameters: StepParameters,
        aim: Any,
        state: BodyState,
        memory: Any,
        action: Any,
        time: float,
        steps: int,
    ) -> PeriodOutcome:
        step = advance(parameters, state, act(aim, action), time, steps)
        motion = motion_of(parameters, step.state)
        memory_after = remember(aim, memory, motion)
        return PeriodOutcome(
            step, memory_after, observe(aim, memory_after, motion), judge(aim, motion, action)
        )

    return control_period
