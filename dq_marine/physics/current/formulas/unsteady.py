"""Uniform current that changes with time: linearly within a control period, at random from one to the next.

In the frame that moves with the water, which accelerates with a = u', the water is at rest, and -a adds to gravity: the
body is pulled by -m a at its centre of gravity and buoyed by rho V a at its centre of buoyancy (docs/theory.md,
"Current"). In half a step the velocity of the water changes by du and hence

    mu <- mu + [(rho V r_B - m r_G) x R^T du; (rho V - m) R^T du]                                     (U1)

at frozen pose. A neutral body whose centres coincide is carried along like the water that it displaces.

The velocity itself may be a first-order Gauss-Markov process (as in Fossen 2021, on ocean current models) about a mean,

    u(t + T) = mean + exp(-T/tau) (u(t) - mean) + s sqrt(1 - exp(-2 T/tau)) n,  n standard normal     (U2)

exact for any T. T is the control period, in which u goes linearly from the one to the other.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_translate
from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial, spatial_add
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, scale, subtract
from dq_marine.integrator.inertia import Inertia
from dq_marine.integrator.staged import StageForces
from dq_marine.integrator.step import StepParameters
from dq_marine.integrator.water import CurrentDraw, Placed, Water, WaterAtStages, as_it_is


class Course(NamedTuple):
    """How the velocity of the water goes on: u(t) = velocity + (t - time) rate, in NED [m/s], [m/s^2]."""

    velocity: Vector3
    rate: Vector3
    time: float


class Displacement(NamedTuple):
    """rho V - m [kg], and rho V r_B - m r_G [kg m] in the body frame."""

    excess: float
    moment: Vector3


class Process(NamedTuple):
    """A Gauss-Markov process in steps of a period.

    Attributes:
        mean: in NED [m/s].
        memory: exp(-T/tau), share of the deviation from the mean that a period leaves.
        gust: s sqrt(1 - exp(-2 T/tau)), standard deviation of what it adds to each horizontal component [m/s].
        period: T [s].
    """

    mean: Vector3
    memory: float
    gust: float
    period: float


class UnsteadyCurrent(NamedTuple):
    """A current's course, what body and displaced water weigh in it, and how it goes on after a period."""

    course: Course
    displacement: Displacement
    process: Process


def course_velocity(course: Course, time: float) -> Vector3:
    """Return the velocity of the water in NED [m/s] at a time [s]."""
    return add_scaled(course.velocity, time - course.time, course.rate)


def draw_stationary(draw: CurrentDraw, first: float, second: float) -> Vector3:
    """Return a velocity in NED [m/s] about the mean `fixed`, with standard deviation `speed` of each component."""
    north, east = normal_pair(first, second)
    return add(draw.fixed, (draw.speed * north, draw.speed * east, 0.0))


def steady_course(current: UnsteadyCurrent, velocity: Vector3) -> UnsteadyCurrent:
    """Return the parameters of water that begins with a velocity in NED [m/s].

    Its course does not change yet, so that its time does not matter; it is 0, whatever the water did before.
    """
    return UnsteadyCurrent(Course(velocity, (0.0, 0.0, 0.0), 0.0), current.displacement, current.process)


def unsteady_velocity(current: UnsteadyCurrent, pose: DualQuaternion) -> Vector3:
    """Return the velocity of the water in NED [m/s] at the course's time: the end of a control period."""
    return current.course.velocity


def unsteady_twist(current: UnsteadyCurrent, pose: DualQuaternion) -> Spatial:
    """Return the same as a twist in the body frame."""
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, current.course.velocity))


def half_way(
    current: UnsteadyCurrent, middle: float, h: float, pose: DualQuaternion, momentum: Spatial
) -> Placed:
    """Return what the water does in h/2 about the time `middle`: (U1), and its way, exactly."""
    change = rotate_inverse(pose.real, scale(0.5 * h, current.course.rate))
    impulse = Spatial(cross(current.displacement.moment, change), scale(current.displacement.excess, change))
    way = scale(0.5 * h, course_velocity(current.course, middle))
    return Placed(pose_translate(pose, way), spatial_add(momentum, impulse))


def carry_unsteadily(
    current: UnsteadyCurrent, time: float, elapsed: float, pose: DualQuaternion
) -> DualQuaternion:
    """Return the pose displaced by the water's way, exactly: its velocity is linear in time."""
    return pose_translate(pose, scale(elapsed, course_velocity(current.course, time + 0.5 * elapsed)))


@functools.cache
def in_accelerating_water(forces: StageForces) -> StageForces:
    """Return the forces in still water, and the rate of (U1)."""

    def forces_in_accelerating_water(
        parameters: StepParameters, pose: DualQuaternion, twist: Spatial, time: float, wrench: Spatial
    ) -> Spatial:
        course, displaced, _ = parameters.water
        rate = rotate_inverse(pose.real, course.rate)
        push = Spatial(cross(displaced.moment, rate), scale(displaced.excess, rate))
        return spatial_add(forces(parameters, pose, twist, time, wrench), push)

    return forces_in_accelerating_water


def depart_unsteadily(
    current: UnsteadyCurrent,
    inertia: Inertia,
    time: float,
    h: float,
    pose: DualQuaternion,
    momentum: Spatial,
) -> Placed:
    """Return what the water does in the first half of a drift."""
    return half_way(current, time + 0.25 * h, h, pose, momentum)


def arrive_unsteadily(
    current: UnsteadyCurrent,
    inertia: Inertia,
    time: float,
    h: float,
    pose: DualQuaternion,
    momentum: Spatial,
) -> Placed:
    """Return what the water does in the second half of a drift."""
    return half_way(current, time + 0.75 * h, h, pose, momentum)


def head_for(current: UnsteadyCurrent, velocity: Vector3, time: float, duration: float) -> UnsteadyCurrent:
    """Return the parameters of water that goes linearly from where it is at `time` to a velocity `duration` later."""
    now = course_velocity(current.course, time)
    rate = scale(1.0 / duration, subtract(velocity, now))
    return UnsteadyCurrent(Course(velocity, rate, time + duration), current.displacement, current.process)


def settled(current: UnsteadyCurrent, time: float) -> UnsteadyCurrent:
    """Return the same water, with its velocity given at another time."""
    course = current.course
    moved = Course(course_velocity(course, time), course.rate, time)
    return UnsteadyCurrent(moved, current.displacement, current.process)


def wander(current: UnsteadyCurrent, time: float, uniforms: tuple[float, float]) -> UnsteadyCurrent:
    """Return the parameters for the control period that begins at `time`, from two uniform random numbers."""
    process = current.process
    north, east = normal_pair(uniforms[0], uniforms[1])
    deviation = scale(process.memory, subtract(course_velocity(current.course, time), process.mean))
    gust = (process.gust * north, process.gust * east, 0.0)
    return head_for(current, add(add(process.mean, deviation), gust), time, process.period)  # (U2)


UNSTEADY_WATER = Water(
    draw_stationary,
    steady_course,
    depart_unsteadily,
    arrive_unsteadily,
    WaterAtStages(carry_unsteadily, in_accelerating_water, as_it_is),
    unsteady_velocity,
    unsteady_twist,
    wander,
    2,
)
