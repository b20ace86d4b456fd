"""Smooth paths by few numbers: uniform cubic B-splines, which have continuous curvature everywhere.

Between knots i and i + 1, with t = s - i and the control points P_i .. P_i+3 (de Boor 1978, A Practical Guide
to Splines):

    p(s) = ((1 - t)^3 P_i + (3 t^3 - 6 t^2 + 4) P_i+1 + (-3 t^3 + 3 t^2 + 3 t + 1) P_i+2 + t^3 P_i+3) / 6       (1)

A path of n spans has n + 3 control points, and its parameter s goes from 0 to n. If legs between control points have
the length l in a plane, and the course changes by D from one to the next, the curvature at the knot between them is

    kappa = 2 sin(D/2) / (l cos(D/2)^2).                                                                        (2)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, norm, scale, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.harmonics import CurvePoint, level_course

LONGEST_STEP = 0.25
"""Of the parameter, in one of Newton's steps towards the nearest point."""


class Spline(NamedTuple):
    """A path of a number of spans, as pure functions of its control points.

    Attributes:
        point: (control points, parameter) -> where that is, with slope and bend [m].
        nearest: (control points, parameter, position) -> parameter nearer to the nearest point, by one of Newton's
            steps: two in a control period follow a vehicle.
    """

    point: Callable[[Any, float], CurvePoint]
    nearest: Callable[[Any, float, Vector3], float]


class PathAxes(NamedTuple):
    """Unit vectors in NED along a path, to its starboard (level), and down, square to both."""

    ahead_ned: Vector3
    starboard_ned: Vector3
    down_ned: Vector3


class Beside(NamedTuple):
    """A vehicle beside a path: axes there, distance, how far to starboard and below [m], speed along the path [m/s]."""

    axes: PathAxes
    distance: float
    starboard: float
    below: float
    speed: float


def make_spline(spans: int) -> Spline:
    """Return the functions of a path of so many spans."""
    window, last = _make_window(spans), float(spans)

    def point(controls: Any, parameter: float) -> CurvePoint:
        start, a, b, c, d = window(parameter, controls)
        return _on_span(parameter - start, a, b, c, d)

    def nearest(controls: Any, parameter: float, position_ned: Vector3) -> float:
        here = point(controls, parameter)
        off = subtract(here.position_ned, position_ned)
        squared = dot(here.slope_ned, here.slope_ned)
        # Where the position is beyond the centre of curvature, Newton's denominator is not that of a nearest point.
        steepness = max(squared + dot(off, here.bend_ned), 0.25 * squared)
        step = max(-LONGEST_STEP, min(LONGEST_STEP, -dot(off, here.slope_ned) / steepness))
        return max(0.0, min(last, parameter + step))

    return Spline(point, nearest)


def make_onward(point: Callable[[Any, float], CurvePoint]) -> Callable[[Any, float, float, float], float]:
    """Return (control points, parameter, length of the slope there, short way [m]) -> parameter after that way.

    It is by the midpoint rule.
    """

    def onward(controls: Any, parameter: float, stretch: float, way: float) -> float:
        half = parameter + 0.5 * way / stretch
        return parameter + way / norm(point(controls, half).slope_ned)

    return onward


def path_axes(point: CurvePoint) -> PathAxes:
    """Return the axes of a path at a point, which must not be vertical there."""
    slope = point.slope_ned
    ahead = scale(1.0 / norm(slope), slope)
    starboard = level_course(slope)[1]
    return PathAxes(ahead, starboard, cross(ahead, starboard))


def beside(point: CurvePoint, motion: Motion) -> Beside:
    """Return where a vehicle is, beside a path's point that is nearest to it."""
    axes, off = path_axes(point), subtract(motion.position_ned, point.position_ned)
    speed = dot(rotate(motion.attitude, motion.velocity.linear), axes.ahead_ned)
    return Beside(axes, norm(off), dot(off, axes.starboard_ned), dot(off, axes.down_ned), speed)


def curvature(point: CurvePoint) -> Vector3:
    """Return the curvature vector [1/m] in NED: it points to the inside of the bend, square to the path."""
    slope, bend = point.slope_ned, point.bend_ned
    squared = dot(slope, slope)
    return scale(1.0 / squared, add_scaled(bend, -dot(bend, slope) / squared, slope))


def make_winding(spans: int) -> Callable[[Vector3, float, float, float, tuple[float, ...], int], Any]:
    """Return (begin, leg [m], turn [rad], climb [rad], uniforms, index) -> control points of a path that is drawn.

    It begins at `begin`, straight and at any course, and each leg turns by at most `turn` against the one before. Each
    goes up or down by at most `climb`. One uniform random number for the first course and two for each span are used,
    from `index` on: `winding_draws(spans)`.
    """
    extend = _make_extension(spans)

    def winding(
        begin: Vector3, leg: float, turn: float, climb: float, uniforms: tuple[float, ...], index: int
    ) -> Any:
        course = 2.0 * math.pi * uniforms[index]
        way = (leg * math.cos(course), leg * math.sin(course), 0.0)
        second = add(begin, way)
        return (
            subtract(begin, way),
            begin,
            second,
            *extend(second, course, leg, turn, climb, uniforms, index + 1),
        )

    return winding


def winding_draws(spans: int) -> int:
    """Return how many uniform random numbers a path that is drawn takes."""
    return 1 + 2 * spans


def _make_extension(count: int) -> Callable[..., Any]:
    """Return (point, course, leg, turn, climb, uniforms, index) -> `count` points that go on from there."""

    def one(
        point: Vector3,
        course: float,
        leg: float,
        turn: float,
        climb: float,
        uniforms: tuple[float, ...],
        index: int,
    ) -> Any:
        onward = course + turn * (2.0 * uniforms[index] - 1.0)
        slope = climb * (2.0 * uniforms[index + 1] - 1.0)
        level = leg * math.cos(slope)
        return (add(point, (level * math.cos(onward), level * math.sin(onward), leg * math.sin(slope))),)

    if count == 1:
        return one
    rest = _make_extension(count - 1)

    def extend(
        point: Vector3,
        course: float,
        leg: float,
        turn: float,
        climb: float,
        uniforms: tuple[float, ...],
        index: int,
    ) -> Any:
        following = one(point, course, leg, turn, climb, uniforms, index)
        onward = course + turn * (2.0 * uniforms[index] - 1.0)
        return (*following, *rest(following[0], onward, leg, turn, climb, uniforms, index + 2))

    return extend


def _make_window(spans: int, first: int = 0) -> Callable[[float, Any], Any]:
    """Return (parameter, control points) -> where its span starts, and the four control points of that."""
    start, second, third, fourth = float(first), first + 1, first + 2, first + 3

    def own(parameter: float, controls: Any) -> Any:
        return (
            0.0 * parameter + start,
            controls[first],
            controls[second],
            controls[third],
            controls[fourth],
        )

    if first == spans - 1:
        return own
    rest = _make_window(spans, first + 1)

    def window(parameter: float, controls: Any) -> Any:
        return select(parameter < start + 1.0, own(parameter, controls), rest(parameter, controls))

    return window


def _on_span(t: float, a: Vector3, b: Vector3, c: Vector3, d: Vector3) -> CurvePoint:
    """Return (1) and its derivatives."""
    u, t2 = 1.0 - t, t * t
    t3 = t2 * t
    return CurvePoint(
        _mixed(
            u * u * u / 6.0,
            a,
            (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0,
            b,
            (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
            c,
            t3 / 6.0,
            d,
        ),
        _mixed(
            -0.5 * u * u,
            a,
            1.5 * t2 - 2.0 * t,
            b,
            -1.5 * t2 + t + 0.5,
            c,
            0.5 * t2,
            d,
        ),
        _mixed(u, a, 3.0 * t - 2.0, b, 1.0 - 3.0 * t, c, t, d),
    )


def _mixed(p: float, a: Vector3, q: float, b: Vector3, r: float, c: Vector3, s: float, d: Vector3) -> Vector3:
    return add_scaled(add_scaled(add_scaled(scale(p, a), q, b), r, c), s, d)
