"""Semi-implicit ("symplectic") Euler: momentum by the rates at the step's start, then the pose by the new velocity.

What physics engines do with a free body: first v += h a, then x += h v. All forces are explicit, Coriolis and Munk's
included, as an engine has them that is handed hydrodynamics from outside. The position moves by the new velocity in the
new attitude, which is the velocity in the world that an engine holds. Engines hold the velocity of the centre of mass
and a scalar mass; the fully coupled M here is more than they can represent.
"""

from __future__ import annotations

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.spatial import Spatial, spatial_add_scaled
from dq_marine.algebra.vector3 import add_scaled
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import Point, make_landing, make_momentum_rate, twist_at
from dq_marine.report.baselines.normalisation import turned


def make_semi_implicit_euler(composition: Composition) -> Advance:
    """Return the advance of semi-implicit Euler: one evaluation of all forces a step."""
    momentum_rate = make_momentum_rate(composition)
    land = make_landing(composition)

    def semi_implicit_euler(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        twist = twist_at(parameters, point)
        for step in range(steps):
            rate = momentum_rate(parameters, point, twist, time, step * h, wrench)
            momentum = spatial_add_scaled(point.momentum, h, rate)
            twist = twist_from_momentum(parameters.inertia, momentum)
            attitude = turned(point.attitude, h, twist.angular)
            position = add_scaled(point.position, h, rotate(attitude, twist.linear))
            point = Point(attitude, position, momentum)
        return land(parameters, state, point, time, steps, 0)

    return semi_implicit_euler
