"""Dormand and Prince's method of order 8, with fixed steps, on position, quaternion and momentum.

The equations are those of `rk4_quaternion`, and so is what is made of them: the quaternion is normalised after each
step, nothing else is. It is the strongest explicit method that is in common use for small errors, known as DOP853.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.stages import weighted_sum
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.dormand_prince import DORMAND_PRINCE
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import Point, make_landing
from dq_marine.report.baselines.normalisation import normalised
from dq_marine.report.baselines.rk4_quaternion import Rates, make_rates, moved


class Step(NamedTuple):
    """What the rates in a step depend on besides where the body is; times in seconds."""

    parameters: StepParameters
    time: float
    elapsed: float
    wrench: Spatial


def follow(point: Point, change: Rates) -> Point:
    """Return point + change."""
    return moved(point, 1.0, change)


def make_find(composition: Composition) -> Callable[[Step, float, Point], Rates]:
    """Return (step, share of it that is over, point) -> the rates there, times h."""
    rates_at = make_rates(composition)

    def find(step: Step, share: float, point: Point) -> Rates:
        h = step.parameters.timing.h
        there = rates_at(step.parameters, point, step.time, step.elapsed + share * h, step.wrench)
        scaled: Rates = weighted_sum((h,), (there,))
        return scaled

    return find


def make_dop853(composition: Composition) -> Advance:
    """Return the advance: twelve evaluations of all forces a step."""
    take_step = DORMAND_PRINCE.make_step(make_find(composition), follow)
    land = make_landing(composition)

    def dop853(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        for step in range(steps):
            reached = follow(point, take_step(Step(parameters, time, step * h, wrench), point).change)
            point = Point(normalised(reached.attitude), reached.position, reached.momentum)
        return land(parameters, state, point, time, steps, 0)

    return dop853
