"""Curves as sums of harmonics, which a point runs through in time: circles, helices, lemniscates, and any other.

    p(phi) = c + d phi + sum over k = 1..3 of a_k cos(k phi) + b_k sin(k phi)                          (1)

With the phase phi = w t, position, velocity and acceleration are smooth in closed form, and a curve is only numbers.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.level import level_cross, level_dot, level_length
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, scale, subtract


class Curve(NamedTuple):
    """The coefficients of (1) [m] in NED: c, d, and of each harmonic those of cosine and sine."""

    center_ned: Vector3
    drift_ned: Vector3
    cosines: tuple[Vector3, Vector3, Vector3]
    sines: tuple[Vector3, Vector3, Vector3]


class CurvePoint(NamedTuple):
    """Where a point on a curve is, and its first and second derivative by the phase [m]."""

    position_ned: Vector3
    slope_ned: Vector3
    bend_ned: Vector3


def curve_point(curve: Curve, phase: float) -> CurvePoint:
    """Return (1) and its derivatives at a phase [rad]; cosines and sines of the multiples by the addition theorem."""
    s1, c1 = sine_and_cosine(phase)
    c2, s2 = c1 * c1 - s1 * s1, 2.0 * c1 * s1
    c3, s3 = c2 * c1 - s2 * s1, s2 * c1 + c2 * s1
    first = _harmonic(curve.cosines[0], curve.sines[0], c1, s1, 1.0)
    second = _harmonic(curve.cosines[1], curve.sines[1], c2, s2, 2.0)
    third = _harmonic(curve.cosines[2], curve.sines[2], c3, s3, 3.0)
    return CurvePoint(
        add_scaled(
            add(curve.center_ned, add(first.position_ned, add(second.position_ned, third.position_ned))),
            phase,
            curve.drift_ned,
        ),
        add(curve.drift_ned, add(first.slope_ned, add(second.slope_ned, third.slope_ned))),
        add(first.bend_ned, add(second.bend_ned, third.bend_ned)),
    )


def level_course(slope_ned: Vector3) -> tuple[Vector3, Vector3]:
    """Return where a curve goes and its starboard, seen from above: two level unit vectors in NED."""
    north, east = slope_ned[0], slope_ned[1]
    level = level_length((north, east))
    north, east = north / level, east / level
    return ((north, east, 0.0), (-east, north, 0.0))


def course_rate(point: CurvePoint, rate: float) -> float:
    """Return how fast the course turns [rad/s], of a point whose phase grows at a rate [rad/s]."""
    slope, bend = (point.slope_ned[0], point.slope_ned[1]), (point.bend_ned[0], point.bend_ned[1])
    return rate * level_cross(slope, bend) / level_dot(slope, slope)


def moved_to(curve: Curve, phase: float, position_ned: Vector3) -> Curve:
    """Return the curve, displaced so that it is at a position at a phase."""
    off = subtract(position_ned, curve_point(curve, phase).position_ned)
    return Curve(add(curve.center_ned, off), curve.drift_ned, curve.cosines, curve.sines)


def _harmonic(cosine: Vector3, sine: Vector3, c: float, s: float, k: float) -> CurvePoint:
    """Return one term of (1), with its derivatives."""
    position = add(scale(c, cosine), scale(s, sine))
    slope = scale(k, subtract(scale(c, sine), scale(s, cosine)))
    return CurvePoint(position, slope, scale(-(k * k), position))
