"""A partner along a winding course of its own, and how a vehicle goes beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.level import from_above, seen_at
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.vector3 import Vector3, add_scaled, norm, scale, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Sender
from dq_marine.task.formation import Winding
from dq_marine.task.harmonics import level_course
from dq_marine.task.splines import make_onward, make_spline, make_winding, winding_draws


class Course(NamedTuple):
    """Control points of the partner's course [m], and its parameter there."""

    controls: Any
    parameter: float


class Company(NamedTuple):
    """How a vehicle goes beside another: distance [m]; difference of speeds [m/s], and of courses [rad], unsigned."""

    distance: float
    speed_error: float
    course_error: float


class Partners(NamedTuple):
    """A partner along a course of a number of spans, as pure functions.

    Attributes:
        draws: uniform random numbers that a course takes.
        drawn: (where it begins [m], what it is drawn by, uniforms, index) -> course at its beginning.
        onward: (course, way [m], which is short) -> course after it.
        partner: (course, speed [m/s]) -> where the partner is, and how it goes.
    """

    draws: int
    drawn: Callable[[Vector3, Winding, tuple[float, ...], int], Course]
    onward: Callable[[Course, float], Course]
    partner: Callable[[Course, float], Sender]


def make_partners(spans: int) -> Partners:
    """Return the functions of a partner whose course has so many spans, about a leg each."""
    point, wind = make_spline(spans).point, make_winding(spans)
    further = make_onward(point)

    def drawn(begin: Vector3, winding: Winding, uniforms: tuple[float, ...], index: int) -> Course:
        return Course(wind(begin, winding.leg, winding.turn, winding.climb, uniforms, index), 0.0)

    def onward(course: Course, way: float) -> Course:
        controls, parameter = course
        stretch = norm(point(controls, parameter).slope_ned)
        return Course(controls, further(controls, parameter, stretch, way))

    def partner(course: Course, speed: float) -> Sender:
        here = point(course.controls, course.parameter)
        return Sender(here.position_ned, scale(speed / norm(here.slope_ned), here.slope_ned))

    return Partners(winding_draws(spans), drawn, onward, partner)


def company(other: Sender, motion: Motion) -> Company:
    """Return how a vehicle goes beside another: by velocities over ground, as a current turns bows off courses."""
    velocity_ned = rotate(motion.attitude, motion.velocity.linear)
    return Company(
        norm(subtract(other.position_ned, motion.position_ned)),
        abs(norm(velocity_ned) - norm(other.velocity_ned)),
        abs(seen_at(from_above(velocity_ned), from_above(other.velocity_ned))),
    )


def abreast(other: Sender, least: float, most: float) -> Sender:
    """Return who goes to starboard of another, midway between a least and a largest distance [m]."""
    _, starboard = level_course(other.velocity_ned)
    return Sender(add_scaled(other.position_ned, 0.5 * (least + most), starboard), other.velocity_ned)
