"""The exponential map of SE(3) for the short displacements of a step: a quaternion and a translation.

For chi = [omega; v], a twist times a duration, theta = |omega|,

    r = (cos(theta/2), sinc(theta/2) omega/2),
    l = v + b omega x v + c omega x (omega x v),  b = (1 - cos(theta))/theta^2, c = (theta - sin(theta))/theta^3

By polynomials where the half angle is small, with an error below round-off; by sine and cosine beyond.
`algebra.screw.pose_exp` is made for any angle and to the last bit, and takes longer.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, add_scaled, cross, dot

SHORT = 0.09
"""Square of the half angle [rad^2] up to which the polynomials are used: a turn by 0.6 rad."""


class Displacement(NamedTuple):
    """A turn, and the translation [m], both in the frame before."""

    turn: Quaternion
    translation: Vector3


class Coefficients(NamedTuple):
    """cos(theta/2), sinc(theta/2), b and c (see the head of this file)."""

    cosine: float
    sinc: float
    b: float
    c: float


def short_coefficients(x: float) -> Coefficients:
    """Return the coefficients for the square x of a small half angle, by their series."""
    cosine = 1.0 / 479001600.0
    cosine = x * cosine - 1.0 / 3628800.0
    cosine = x * cosine + 1.0 / 40320.0
    cosine = x * cosine - 1.0 / 720.0
    cosine = x * cosine + 1.0 / 24.0
    cosine = x * cosine - 0.5
    cosine = x * cosine + 1.0
    sinc = 1.0 / 6227020800.0
    sinc = x * sinc - 1.0 / 39916800.0
    sinc = x * sinc + 1.0 / 362880.0
    sinc = x * sinc - 1.0 / 5040.0
    sinc = x * sinc + 1.0 / 120.0
    sinc = x * sinc - 1.0 / 6.0
    sinc = x * sinc + 1.0
    y = 4.0 * x
    c = 1.0 / 355687428096000.0
    c = 1.0 / 1307674368000.0 - y * c
    c = 1.0 / 6227020800.0 - y * c
    c = 1.0 / 39916800.0 - y * c
    c = 1.0 / 362880.0 - y * c
    c = 1.0 / 5040.0 - y * c
    c = 1.0 / 120.0 - y * c
    c = 1.0 / 6.0 - y * c
    return Coefficients(cosine, sinc, 0.5 * sinc * sinc, c)


def long_coefficients(x: float) -> Coefficients:
    """Return the coefficients for the square x of a half angle that is not small; NaN if x is not finite."""
    half = math.sqrt(x + (x - x))  # NaN for an infinity, for which math.sin would raise
    cosine, sine = math.cos(half), math.sin(half)
    angle = 2.0 * half
    c = (angle - 2.0 * sine * cosine) / (angle * angle * angle)
    return Coefficients(cosine, sine / half, 0.5 * (sine / half) * (sine / half), c)


def displaced(twist: Spatial) -> Displacement:
    """Return the displacement exp(chi) of a twist times its duration [rad; m]."""
    omega, v = twist.angular, twist.linear
    x = 0.25 * dot(omega, omega)
    cosine, sinc, b, c = short_coefficients(x) if x < SHORT else long_coefficients(x)
    across = cross(omega, v)
    half = 0.5 * sinc
    return Displacement(
        (cosine, half * omega[0], half * omega[1], half * omega[2]),
        add_scaled(add_scaled(v, b, across), c, cross(omega, across)),
    )
