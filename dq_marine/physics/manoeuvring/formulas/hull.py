"""What the water does to a manoeuvring hull, by the polynomials of the MMG model in v' and r'.

Yasukawa, H., and Yoshimura, Y. (2015), Introduction of MMG standard method for ship maneuvering predictions, Journal of
Marine Science and Technology 20, 37-52, eqs. 6 and 7; (P1) to (P6) are those of docs/theory.md.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import smallest_normal
from dq_marine.algebra.spatial import Spatial


class SurgePolynomial(NamedTuple):
    """R'_0, X'_vv, X'_vr, X'_rr, X'_vvvv."""

    resistance: float
    vv: float
    vr: float
    rr: float
    vvvv: float


class LateralPolynomial(NamedTuple):
    """Y'_v to Y'_rrr, or N'_v to N'_rrr."""

    v: float
    r: float
    vvv: float
    vvr: float
    vrr: float
    rrr: float


class PolynomialRange(NamedTuple):
    """Where the polynomials hold: |v'| up to `drift`, the sine of an angle, `ahead` its cosine; |r'| up to `turn`."""

    drift: float
    ahead: float
    turn: float


class ManoeuvringHull(NamedTuple):
    """The numbers of a hull.

    Attributes:
        surge: polynomial of X'.
        sway: polynomial of Y'.
        yaw: polynomial of N'.
        validity: of all three.
        length: L between perpendiculars [m].
        pressure: rho L d/2, force over the square of a speed [kg/m].
        munk: A_22 - A_11, the Munk moment of M over u v [kg].
        skew: A_12, the same over u^2 - v^2: 0 of a ship that is alike on both sides [kg].
        depth: z at which X and Y act [m].
    """

    surge: SurgePolynomial
    sway: LateralPolynomial
    yaw: LateralPolynomial
    validity: PolynomialRange
    length: float
    pressure: float
    munk: float
    skew: float
    depth: float


class HullMotion(NamedTuple):
    """What the polynomials are evaluated at.

    Attributes:
        speed: V, that forces are made dimensionless with [m/s].
        ahead: f, 1 wherever the polynomials hold, -1 for their mirror image astern.
        drift: v'.
        turn: r'.
    """

    speed: float
    ahead: float
    drift: float
    turn: float


def within(limit: float, value: float) -> float:
    """Return the value held between -limit and limit."""
    return max(-limit, min(limit, value))


def hull_motion(hull: ManoeuvringHull, twist: Spatial) -> HullMotion:
    """Return V, f, v' and r' of a velocity through the water."""
    u, v, r = twist.linear[0], twist.linear[1], twist.angular[2]
    validity, round_speed = hull.validity, hull.length * r
    # (P3): where the ship turns faster than the polynomials know, the speed of turning counts.
    speed = max(math.sqrt(u * u + v * v), abs(round_speed) / validity.turn)
    divisor = speed + smallest_normal(speed)
    return HullMotion(
        speed,
        within(1.0, u / (divisor * validity.ahead)),  # (P4)
        within(validity.drift, v / divisor),
        within(validity.turn, round_speed / divisor),
    )


def surge_force(own: SurgePolynomial, motion: HullMotion) -> float:
    """Return X' by (P1), (P5)."""
    a, b = motion.drift, motion.turn
    mirrored = own.rr * b * b - own.resistance + (own.vv + own.vvvv * a * a) * a * a
    return motion.ahead * mirrored + own.vr * a * b


def sway_force(own: LateralPolynomial, motion: HullMotion) -> float:
    """Return Y' by (P1), (P5)."""
    a, b = motion.drift, motion.turn
    kept = (own.v + own.vvv * a * a + own.vrr * b * b) * a
    return kept + motion.ahead * (own.r + own.vvr * a * a + own.rrr * b * b) * b


def yaw_moment(own: LateralPolynomial, motion: HullMotion) -> float:
    """Return N' by (P1), (P5)."""
    a, b = motion.drift, motion.turn
    mirrored = (own.v + own.vvv * a * a + own.vrr * b * b) * a
    return motion.ahead * mirrored + (own.r + own.vvr * a * a + own.rrr * b * b) * b


def manoeuvring_hull(hull: ManoeuvringHull, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
    """Return the wrench of the hull, without what M gives already: (P2)."""
    motion = hull_motion(hull, twist)
    pressure = hull.pressure * motion.speed * motion.speed
    x = pressure * surge_force(hull.surge, motion)
    y = pressure * sway_force(hull.sway, motion)
    u, v = twist.linear[0], twist.linear[1]
    munk = hull.munk * u * v + hull.skew * (u * u - v * v)
    n = pressure * hull.length * yaw_moment(hull.yaw, motion) + munk
    return Spatial((-hull.depth * y, hull.depth * x, n), (x, y, 0.0))
