"""Euler's explicit method: pose and momentum both by the rates at the step's start.

The one-line integrator of small simulators: nu += h nu', eta += h J(eta) nu. The attitude is a quaternion, so that no
pitch is singular.
"""

from __future__ import annotations

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.spatial import Spatial, spatial_add_scaled
from dq_marine.algebra.vector3 import add_scaled
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import Point, make_landing, make_momentum_rate, twist_at
from dq_marine.report.baselines.normalisation import turned


def make_explicit_euler(composition: Composition) -> Advance:
    """Return the advance of Euler's method: one evaluation of all forces a step."""
    momentum_rate = make_momentum_rate(composition)
    land = make_landing(composition)

    def explicit_euler(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        for step in range(steps):
            twist = twist_at(parameters, point)
            rate = momentum_rate(parameters, point, twist, time, step * h, wrench)
            point = Point(
                turned(point.attitude, h, twist.angular),
                add_scaled(point.position, h, rotate(point.attitude, twist.linear)),
                spatial_add_scaled(point.momentum, h, rate),
            )
        return land(parameters, state, point, time, steps, 0)

    return explicit_euler
