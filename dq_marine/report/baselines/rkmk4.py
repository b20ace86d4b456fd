"""Runge-Kutta and Munthe-Kaas's method of order 4 on SE(3) x R^6: pose by the Lie group, momentum by its components.

A step moves by g = g_k exp(u) with u in the Lie algebra, so that poses stay poses; mu is a vector.

    u' = dexp_u^-1 chi,     mu' by (Ri1)

The classical coefficients with the two commutators that order 4 needs, in body coordinates (Munthe-Kaas 1999, Appl.
Numer. Math. 29, 115; Iserles et al. 2000, Acta Numerica 9, 215):

    u2 = k1/2,  u3 = k2/2 + [k1, k2]/8,  u4 = k3,  u = (k1 + 2 k2 + 2 k3 + k4)/6 + [k1, k4]/12
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.frames import twist_bracket
from dq_marine.algebra.quaternion import quaternion_multiply, rotate
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_scale
from dq_marine.algebra.vector3 import add
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.classical_runge_kutta import NODES
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.displacement import displaced
from dq_marine.report.baselines.dynamics import (
    Foreseen,
    Point,
    make_foresee,
    make_landing,
    make_momentum_rate,
    twist_at,
    without_time_forces,
)
from dq_marine.report.baselines.normalisation import normalised


class Slope(NamedTuple):
    """The step size times chi, and times mu'."""

    twist: Spatial
    impulse: Spatial


def arrived(start: Point, displacement: Spatial, momentum: Spatial) -> Point:
    """Return the body displaced by exp(u), with a momentum."""
    way = displaced(displacement)
    return Point(
        quaternion_multiply(start.attitude, way.turn),
        add(start.position, rotate(start.attitude, way.translation)),
        momentum,
    )


def simpson(k1: Spatial, k2: Spatial, k3: Spatial, k4: Spatial) -> Spatial:
    """Return (k1 + 2 k2 + 2 k3 + k4)/6."""
    middle = spatial_add(k2, k3)
    return spatial_scale(1.0 / 6.0, spatial_add_scaled(spatial_add(k1, k4), 2.0, middle))


def make_rkmk4(composition: Composition) -> Advance:
    """Return the advance of RKMK4: four evaluations of all forces a step, and four exponentials.

    Where no force depends on the pose only the last exponential is needed, and only that is computed.
    """
    momentum_rate = make_momentum_rate(without_time_forces(composition))
    foresee, land = make_foresee(composition), make_landing(composition)

    def slope_at(parameters: StepParameters, point: Point, start: float, foreseen: Foreseen) -> Slope:
        h = parameters.timing.h
        twist = twist_at(parameters, point)
        rate = momentum_rate(parameters, point, twist, start, foreseen.elapsed, foreseen.wrench)
        return Slope(spatial_scale(h, twist), spatial_scale(h, rate))

    def rkmk4(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        for step in range(steps):
            early, middle, late = foresee(parameters, time, step * h, wrench, NODES)
            mu = point.momentum
            k1 = slope_at(parameters, point, time, early)
            u2, mu2 = spatial_scale(0.5, k1.twist), spatial_add_scaled(mu, 0.5, k1.impulse)
            k2 = slope_at(parameters, arrived(point, u2, mu2), time, middle)
            turning = twist_bracket(k1.twist, k2.twist)
            u3 = spatial_add_scaled(spatial_scale(0.5, k2.twist), 0.125, turning)
            mu3 = spatial_add_scaled(mu, 0.5, k2.impulse)
            k3 = slope_at(parameters, arrived(point, u3, mu3), time, middle)
            mu4 = spatial_add(mu, k3.impulse)
            k4 = slope_at(parameters, arrived(point, k3.twist, mu4), time, late)
            u = spatial_add_scaled(
                simpson(k1.twist, k2.twist, k3.twist, k4.twist),
                1.0 / 12.0,
                twist_bracket(k1.twist, k4.twist),
            )
            impulse = simpson(k1.impulse, k2.impulse, k3.impulse, k4.impulse)
            reached = arrived(point, u, spatial_add(mu, impulse))
            point = Point(normalised(reached.attitude), reached.position, reached.momentum)
        return land(parameters, state, point, time, steps, 0)

    return rkmk4
