"""The classical Runge-Kutta method of order 4 on position, quaternion and momentum; the quaternion is normalised.

    q' = (1/2) q omega,     l' = R v,     mu' by (Ri1)

What most simulators of marine vehicles mean by RK4. Between the stages the quaternion is as long as it comes out, which
costs no order.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_add,
    quaternion_from_vector,
    quaternion_multiply,
    quaternion_scale,
    rotate,
)
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_scale
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, scale
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.classical_runge_kutta import NODES
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
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


class Rates(NamedTuple):
    """How fast a `Point` changes, a second."""

    attitude: Quaternion
    position: Vector3
    momentum: Spatial


def moved(point: Point, h: float, rates: Rates) -> Point:
    """Return point + h rates."""
    return Point(
        quaternion_add(point.attitude, quaternion_scale(h, rates.attitude)),
        add_scaled(point.position, h, rates.position),
        spatial_add_scaled(point.momentum, h, rates.momentum),
    )


def simpson(k1: Rates, k2: Rates, k3: Rates, k4: Rates) -> Rates:
    """Return k1 + 2 (k2 + k3) + k4."""
    return Rates(
        quaternion_add(
            quaternion_add(k1.attitude, k4.attitude),
            quaternion_scale(2.0, quaternion_add(k2.attitude, k3.attitude)),
        ),
        add(add(k1.position, k4.position), scale(2.0, add(k2.position, k3.position))),
        spatial_add(
            spatial_add(k1.momentum, k4.momentum),
            spatial_scale(2.0, spatial_add(k2.momentum, k3.momentum)),
        ),
    )


def make_rates(composition: Composition) -> Callable[[StepParameters, Point, float, Foreseen], Rates]:
    """Return (parameters, point, start, what is foreseen of the stage) -> its rates; see `dynamics.make_foresee`."""
    momentum_rate = make_momentum_rate(without_time_forces(composition))

    def rates_at(parameters: StepParameters, point: Point, start: float, foreseen: Foreseen) -> Rates:
        twist = twist_at(parameters, point)
        half_spin = quaternion_from_vector(scale(0.5, twist.angular))
        return Rates(
            quaternion_multiply(point.attitude, half_spin),
            rotate(point.attitude, twist.linear),
            momentum_rate(parameters, point, twist, start, foreseen.elapsed, foreseen.wrench),
        )

    return rates_at


def make_rk4_quaternion(composition: Composition) -> Advance:
    """Return the advance of RK4 on quaternions: four evaluations of all forces a step."""
    rates_at = make_rates(composition)
    foresee, land = make_foresee(composition), make_landing(composition)

    def rk4_quaternion(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        half = 0.5 * h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        for step in range(steps):
            early, middle, late = foresee(parameters, time, step * h, wrench, NODES)
            k1 = rates_at(parameters, point, time, early)
            k2 = rates_at(parameters, moved(point, half, k1), time, middle)
            k3 = rates_at(parameters, moved(point, half, k2), time, middle)
            k4 = rates_at(parameters, moved(point, h, k3), time, late)
            reached = moved(point, h / 6.0, simpson(k1, k2, k3, k4))
            point = Point(normalised(reached.attitude), reached.position, reached.momentum)
        return land(parameters, state, point, time, steps, 0)

    return rk4_quaternion
