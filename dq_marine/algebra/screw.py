"""Exponential and logarithm of unit dual quaternions, screw motion, and interpolation between poses.

A displacement is a twist kept up for one second, chi = [omega; v]: omega is the rotation vector [rad], v [m] the
rest. Every pose is reached from the identity by one, p = exp(chi/2) (Chasles), a turn about a line in space and a
shift along it. The series of exp starts at k = 0, exp(a) = sum of a^k/k!; Xu & Halse (arXiv 1611.00616) print 1.

With the half displacement chi/2 = u + eps w, phi = |u|, and the two even functions

    sinc = sin(phi)/phi,     slope = (cos(phi) - sinc)/phi^2 = (1/phi) d sinc/d phi

it sums up to

    exp(u + eps w) = (cos(phi), sinc u) + eps (-sinc (u.w), sinc w + slope (u.w) u)                  (Sc1)

and, solved for u and w with the unit dual quaternion (c, s) + eps (d, e) on the left,

    u = s/sinc,     w = e/sinc + d slope/sinc^3 s,     phi = atan2(|s|, c)                          (Sc2)

Nothing here divides by an angle that may be small, so both keep full precision down to the identity.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, dual_multiply, dual_scale
from dq_marine.algebra.frames import pose_relative
from dq_marine.algebra.quaternion import quaternion_vector
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale

SERIES_BELOW = 1.0
"""Square of the half angle [rad^2] below which sinc and slope are summed up; above it they are divided out."""

SERIES_TERMS = 9
"""Terms of both series after the first: what follows is under 3e-20 where the series end."""

NO_TURN = 1e-305
"""Angle per metre of shift [rad/m] up to which a screw is taken for a pure translation: the moment would overflow."""


class Screw(NamedTuple):
    """A turn about a line in space and a shift along that line.

    Attributes:
        axis: unit direction n of the line. In a pure translation, its direction; x where nothing moves.
        moment: c x n [m], c any point of the line: its Pluecker moment about the origin. Zero in a pure
            translation, whose axis is at infinity.
        angle: of the turn [rad], not negative; zero in a pure translation.
        translation: along the axis [m], of either sign.
    """

    axis: Vector3
    moment: Vector3
    angle: float
    translation: float


def length(a: Vector3) -> float:
    """Return |a|, to full precision where its square would overflow or underflow."""
    largest = max(abs(a[0]), abs(a[1]), abs(a[2]))
    if largest > 0.0:
        scaled = (a[0] / largest, a[1] / largest, a[2] / largest)
        return largest * math.sqrt(dot(scaled, scaled))
    return abs(a[0]) + abs(a[1]) + abs(a[2])  # zero, or the NaN that `max` may have passed over


def sine_ratios(square: float) -> tuple[float, float]:
    """Return sinc and slope (see the head of this file) of the angle whose square is `square`.

    Below `SERIES_BELOW` cos(phi) and sinc cancel, so both are summed up, innermost term first; the ratio of
    successive terms is -phi^2/(k (k + 1)) in sinc and -phi^2/(k (k + 3)) in slope, k = 2, 4, ...
    """
    if square < SERIES_BELOW:
        sinc = 1.0
        slope = 1.0
        for k in range(2 * SERIES_TERMS, 0, -2):
            sinc = 1.0 - square / (k * (k + 1)) * sinc
            slope = 1.0 - square / (k * (k + 3)) * slope
        return sinc, -slope / 3.0
    angle = math.sqrt(square)
    sinc = math.sin(angle) / angle
    return sinc, (math.cos(angle) - sinc) / square


def pose_exp(displacement: Spatial) -> DualQuaternion:
    """Return the pose exp(chi/2) that a displacement leads to from the identity (Sc1).

    Args:
        displacement: chi = [omega; v], a constant twist times its duration [rad; m], of any angle. It has the
            same components in the moving frame and in that of the start, so either is meant.

    Returns:
        A unit dual quaternion, from the moved frame to that of the start; NaN where |omega|^2 is not finite.
    """
    u = scale(0.5, displacement.angular)
    w = scale(0.5, displacement.linear)
    square = dot(u, u)
    square = square + (square - square)  # NaN for an infinity, for which math.sin would raise
    sinc, slope = sine_ratios(square)
    along = dot(u, w)
    turn = scale(sinc, u)
    shift = add_scaled(scale(sinc, w), slope * along, u)
    return DualQuaternion(
        (math.cos(math.sqrt(square)), turn[0], turn[1], turn[2]),
        (-sinc * along, shift[0], shift[1], shift[2]),
    )


def pose_shortest(pose: DualQuaternion) -> DualQuaternion:
    """Return p or -p, the same pose: that with the scalar part not negative, which turns by at most pi.

    Between two half turns about the same axis, where the scalar part is zero, the first component of the axis
    that is not zero decides, so that p and -p always give the same.
    """
    q = pose.real
    leading = q[0]
    for component in (q[1], q[2], q[3]):
        if leading == 0.0:
            leading = component
    if leading < 0.0:
        return dual_scale(-1.0, pose)
    return pose


def pose_log(pose: DualQuaternion) -> Spatial:
    """Return the displacement chi = 2 log p of the shortest way from the identity to a pose (Sc2).

    Args:
        pose: a unit dual quaternion; p and -p give the same.

    Returns:
        [omega; v] with |omega| <= pi [rad; m]: the constant twist, in the moving frame and in that of the start
        alike, that leads to the pose in one second.
    """
    shortest = pose_shortest(pose)
    s = quaternion_vector(shortest.real)
    half_angle = math.atan2(math.sqrt(dot(s, s)), shortest.real[0])
    sinc, slope = sine_ratios(half_angle * half_angle)
    along = shortest.dual[0] * slope / (sinc * sinc * sinc)
    w = add_scaled(scale(1.0 / sinc, quaternion_vector(shortest.dual)), along, s)
    return Spatial(scale(2.0 / sinc, s), scale(2.0, w))


def screw_from_displacement(displacement: Spatial) -> Screw:
    """Return the screw of a displacement [omega; v]: omega = angle n, v = translation n + angle m.

    A displacement with |omega| <= `NO_TURN` |v| is a pure translation; of zero too, along x.
    """
    angle = length(displacement.angular)
    distance = length(displacement.linear)
    if angle > NO_TURN * distance:
        turn = displacement.angular
        axis = (turn[0] / angle, turn[1] / angle, turn[2] / angle)
        # v without its part along the axis, as n x (v x n): normal to n to round-off, however small it is.
        across = cross(axis, cross(displacement.linear, axis))
        moment = (across[0] / angle, across[1] / angle, across[2] / angle)
        return Screw(axis, moment, angle, dot(axis, displacement.linear))
    axis = (1.0, 0.0, 0.0)
    if distance > 0.0:
        shift = displacement.linear
        axis = (shift[0] / distance, shift[1] / distance, shift[2] / distance)
    return Screw(axis, (0.0, 0.0, 0.0), 0.0, distance)


def displacement_from_screw(screw: Screw) -> Spatial:
    """Return the displacement [angle n; translation n + angle m] [rad; m]."""
    along = scale(screw.translation, screw.axis)
    return Spatial(scale(screw.angle, screw.axis), add(along, scale(screw.angle, screw.moment)))


def screw_from_pose(pose: DualQuaternion) -> Screw:
    """Return the screw of the shortest way from the identity to a pose, angle in [0, pi]."""
    return screw_from_displacement(pose_log(pose))


def pose_from_screw(screw: Screw) -> DualQuaternion:
    """Return the pose that a screw leads to from the identity."""
    return pose_exp(displacement_from_screw(screw))


def screw_pitch(screw: Screw) -> float:
    """Return translation per angle [m/rad]; infinite, with the translation's sign, where nothing turns."""
    if screw.angle > 0.0:
        return screw.translation / screw.angle
    return math.copysign(math.inf, screw.translation)


def screw_point(screw: Screw) -> Vector3:
    """Return the point n x m of the axis that is nearest to the origin [m]; the origin in a pure translation."""
    return cross(screw.axis, screw.moment)


def sclerp(start: DualQuaternion, end: DualQuaternion, fraction: float) -> DualQuaternion:
    """Return the pose at `fraction` of the one screw motion that leads from `start` to `end` the shorter way.

    start exp(fraction log(start` end)). The twist is constant on the way, in the body frame and in the world, and
    the way does not depend on the frames that the poses are expressed in (Kavan et al. 2006, "Dual quaternions
    for rigid transformation blending"). It begins with the sign of `start`, and so may end at minus `end`.

    Args:
        start: pose at fraction 0.
        end: pose at fraction 1.
        fraction: between 0 and 1; outside, the motion goes on.
    """
    displacement = pose_log(pose_relative(start, end))
    return dual_multiply(start, pose_exp(spatial_scale(fraction, displacement)))
