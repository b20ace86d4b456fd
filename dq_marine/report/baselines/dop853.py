"""Dormand and Prince's method of order 8, with fixed steps, on position, quaternion and momentum.

The equations are those of `rk4_quaternion`, and so is what is made of them: the quaternion is normalised after each
step, nothing else is. It is the strongest explicit method that is in common use for small errors, known as DOP853.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.stages import Weights
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.dormand_prince import DORMAND_PRINCE
from dq_marine.integrator.explicit import Find, Foresee
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import Foreseen, Point, make_foresee, make_landing
from dq_marine.report.baselines.normalisation import normalised
from dq_marine.report.baselines.rk4_quaternion import Rates, make_rates


class Step(NamedTuple):
    """What the rates in a step depend on besides where the body is; times in seconds."""

    parameters: StepParameters
    time: float
    elapsed: float
    wrench: Spatial


def make_stages(composition: Composition) -> tuple[Foresee, Find]:
    """Return (step, shares of it that are over) -> what is foreseen, and (step, that, point) -> the rates there."""
    rates_at, foresee = make_rates(composition), make_foresee(composition)

    def foresee_step(step: Step, nodes: Weights) -> tuple[Foreseen, ...]:
        return foresee(step.parameters, step.time, step.elapsed, step.wrench, nodes)

    def find(step: Step, foreseen: Foreseen, point: Point) -> Rates:
        return rates_at(step.parameters, point, step.time, foreseen)

    return foresee_step, find


def make_dop853(composition: Composition) -> Advance:
    """Return the advance: twelve evaluations of all forces a step."""
    take_step = DORMAND_PRINCE.make_step(*make_stages(composition))
    land = make_landing(composition)

    def dop853(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        for step in range(steps):
            reached = take_step(Step(parameters, time, step * h, wrench), h, point).reached
            point = Point(normalised(reached.attitude), reached.position, reached.momentum)
        return land(parameters, state, point, time, steps, 0)

    return dop853
