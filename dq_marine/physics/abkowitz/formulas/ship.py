"""What the water does to a ship with its propeller and rudder, by polynomials about its service speed.

Abkowitz, M. A. (1964), Lectures on Ship Hydrodynamics: Steering and Manoeuvrability, Hydro- and Aerodynamics
Laboratory, Lyngby, Report Hy-5; (W1) to (W5) are those of docs/theory.md. The polynomials are all there is on the
right-hand side of the published equations of motion, centripetal forces too, and the propeller turns as it does at the
service speed, so that a ship that is slower is driven ahead.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.spatial import Spatial
from dq_marine.physics.abkowitz.formulas.polynomial import ShipMotion, make_polynomial


class MotionRange(NamedTuple):
    """What the polynomials know: u' from -`loss` to `gain`, |v'| up to `drift`, |r'| up to `turn`."""

    loss: float
    gain: float
    drift: float
    turn: float


class PlanarMass(NamedTuple):
    """The entries of M for surge, sway and yaw: on the diagonal, and beside it [kg, kg m, kg m^2]."""

    surge: float
    sway: float
    yaw: float
    surge_sway: float
    surge_yaw: float
    sway_yaw: float


class Ship(NamedTuple):
    """The numbers of a ship.

    Attributes:
        service_speed: U_0 [m/s].
        length: L [m].
        pressure: rho L^2/2, force over the square of a speed [kg/m].
        depth: z at which X and Y act [m].
        range: of the polynomials.
        surge: coefficients of X', nested in pairs.
        sway: of Y'.
        yaw: of N'.
    """

    service_speed: float
    length: float
    pressure: float
    depth: float
    range: MotionRange
    surge: Any
    sway: Any
    yaw: Any


class HullAndMass(NamedTuple):
    """A ship's numbers without its rudder, and what M gives of itself."""

    ship: Ship
    mass: PlanarMass


class Products(NamedTuple):
    """The products of a ship's polynomials: letters of u, v, r and d for each coefficient."""

    surge: tuple[str, ...]
    sway: tuple[str, ...]
    yaw: tuple[str, ...]


def ship_motion(ship: Ship, twist: Spatial, rudder: float) -> ShipMotion:
    """Return what polynomials are evaluated at: (W1), (W5)."""
    u, v, r = twist.linear[0], twist.linear[1], twist.angular[2]
    known, change = ship.range, u - ship.service_speed
    speed = max(math.sqrt(u * u + v * v), max(-change / known.loss, abs(r) * ship.length / known.turn))
    return ShipMotion(
        speed,
        min(change / speed, known.gain),
        max(-known.drift, min(known.drift, v / speed)),
        r * ship.length / speed,
        rudder,
    )


@functools.cache
def make_ship_wrench(products: Products) -> Callable[[Ship, ShipMotion], Spatial]:
    """Return (ship, motion) -> the wrench of (W3)."""
    surge_at, sway_at, yaw_at = (make_polynomial(own) for own in products)

    def ship_wrench(ship: Ship, motion: ShipMotion) -> Spatial:
        pressure = ship.pressure * motion.speed * motion.speed
        x, y = pressure * surge_at(ship.surge, motion), pressure * sway_at(ship.sway, motion)
        n = pressure * ship.length * yaw_at(ship.yaw, motion)
        return Spatial((-ship.depth * y, ship.depth * x, n), (x, y, 0.0))

    return ship_wrench


def without_own(mass: PlanarMass, twist: Spatial, depth: float, wrench: Spatial) -> Spatial:
    """Return a wrench without what M gives of itself in the plane (W4)."""
    u, v, r = twist.linear[0], twist.linear[1], twist.angular[2]
    p1 = mass.surge * u + mass.surge_sway * v + mass.surge_yaw * r
    p2 = mass.surge_sway * u + mass.sway * v + mass.sway_yaw * r
    roll, pitch, n = wrench.angular
    x, y, z = wrench.linear
    return Spatial(
        (roll - depth * (r * p1), pitch - depth * (r * p2), n + u * p2 - v * p1), (x - r * p2, y + r * p1, z)
    )


@functools.cache
def make_ship_hull(products: Products) -> Callable[[HullAndMass, DualQuaternion, Spatial, float], Spatial]:
    """Return (numbers, pose, twist, time) -> the wrench of a ship with its rudder amidships."""
    ship_wrench = make_ship_wrench(products)

    def ship_hull(own: HullAndMass, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        wrench = ship_wrench(own.ship, ship_motion(own.ship, twist, 0.0))
        return without_own(own.mass, twist, own.ship.depth, wrench)

    return ship_hull


@functools.cache
def make_ship_rudder(products: Products) -> Callable[[Ship, Any, Spatial], Spatial]:
    """Return (numbers, channels' values, twist) -> the wrench that a ship's rudder adds."""
    ship_wrench = make_ship_wrench(products)

    def ship_rudder(ship: Ship, values: Any, twist: Spatial) -> Spatial:
        return ship_wrench(ship, ship_motion(ship, twist, values[0]))

    return ship_rudder
