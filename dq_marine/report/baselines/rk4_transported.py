"""The classical Runge-Kutta method of order 4 on the pose, with the momentum that the pose carries along.

Integrated are the attitude, the way x since the step's start, and the impulse J of the forces in world axes, about the
place where the step started:

    q' = (1/2) q omega,     x' = R v,     J' = [R m + x x R f; R f],     [m; f] = F(pose, chi, t)          (RT1)

The momentum in the body frame is what the pose makes of the spatial one, chi = M^-1 Ad*_pose (p + J). Without forces
spatial momentum is exact; what the attitude errs, the momentum does, too.
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
    rotate_inverse,
)
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import ZERO, Spatial, spatial_add, spatial_add_scaled
from dq_marine.algebra.stages import weighted_sum
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, scale, subtract
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.classical_runge_kutta import NODES
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import (
    Foreseen,
    Point,
    make_foresee,
    make_landing,
    make_wrench,
    twist_at,
    without_time_forces,
)
from dq_marine.report.baselines.normalisation import normalised

SIMPSON = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)


class Flight(NamedTuple):
    """Attitude, way since the step's start [m], and impulse of the forces since then, in world axes."""

    attitude: Quaternion
    way: Vector3
    impulse: Spatial


class Departure(NamedTuple):
    """What is the same at all stages of a step: where it starts [m], and the spatial momentum about that place."""

    position: Vector3
    momentum: Spatial


def moved(flight: Flight, h: float, rates: Flight) -> Flight:
    """Return flight + h rates."""
    return Flight(
        quaternion_add(flight.attitude, quaternion_scale(h, rates.attitude)),
        add_scaled(flight.way, h, rates.way),
        spatial_add_scaled(flight.impulse, h, rates.impulse),
    )


def arrived(departure: Departure, flight: Flight, attitude: Quaternion) -> Point:
    """Return where a flight has come to, with the momentum that its pose carries there."""
    angular, linear = spatial_add(departure.momentum, flight.impulse)
    about_body = subtract(angular, cross(flight.way, linear))
    momentum = Spatial(rotate_inverse(attitude, about_body), rotate_inverse(attitude, linear))
    return Point(attitude, add(departure.position, flight.way), momentum)


def make_rates(
    composition: Composition,
) -> Callable[[StepParameters, Departure, Flight, float, Foreseen], Flight]:
    """Return (parameters, departure, flight, start, what is foreseen of the stage) -> its rates (RT1)."""
    total = make_wrench(without_time_forces(composition))

    def rates_at(
        parameters: StepParameters,
        departure: Departure,
        flight: Flight,
        start: float,
        foreseen: Foreseen,
    ) -> Flight:
        q = flight.attitude
        point = arrived(departure, flight, q)
        twist = twist_at(parameters, point)
        acting = total(parameters, point, twist, start, foreseen.elapsed, foreseen.wrench)
        force = rotate(q, acting.linear)
        moment = add(rotate(q, acting.angular), cross(flight.way, force))
        half_spin = quaternion_from_vector(scale(0.5, twist.angular))
        return Flight(quaternion_multiply(q, half_spin), rotate(q, twist.linear), Spatial(moment, force))

    return rates_at


def make_rk4_transported(composition: Composition) -> Advance:
    """Return the advance: four evaluations of all forces a step."""
    rates_at = make_rates(composition)
    foresee, land = make_foresee(composition), make_landing(composition)

    def rk4_transported(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        half = 0.5 * h
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        here, no_impulse = spread(((0.0, 0.0, 0.0), ZERO), point.momentum.linear[0])
        for step in range(steps):
            q, (a, b) = point.attitude, point.momentum
            from_here = Departure(point.position, Spatial(rotate(q, a), rotate(q, b)))
            begun = Flight(q, here, no_impulse)
            early, middle, late = foresee(parameters, time, step * h, wrench, NODES)
            k1 = rates_at(parameters, from_here, begun, time, early)
            k2 = rates_at(parameters, from_here, moved(begun, half, k1), time, middle)
            k3 = rates_at(parameters, from_here, moved(begun, half, k2), time, middle)
            k4 = rates_at(parameters, from_here, moved(begun, h, k3), time, late)
            flown = moved(begun, h, weighted_sum(SIMPSON, (k1, k2, k3, k4)))
            point = arrived(from_here, flown, normalised(flown.attitude))
        return land(parameters, state, point, time, steps, 0)

    return rk4_transported
