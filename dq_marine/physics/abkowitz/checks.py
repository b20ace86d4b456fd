"""Checks of a ship's polynomials: that nothing else says the same, and that they fit the ship and hold its speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from dq_marine.physics.abkowitz.build import ACROSS, AHEAD, ROUND, own_axis_force
from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.physics.fields import MOTIONS
from dq_marine.physics.implausible import Implausible

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle

SIZE_RANGE = (0.5, 1.2)  # length between perpendiculars over overall length
FROUDE_RANGE = (0.02, 0.7)  # service speed over sqrt(g L)
IN_THE_PLANE = (AHEAD, ACROSS, ROUND)


def check_whole_ship(vehicle: Vehicle) -> None:
    """Check a vehicle whose fields are each valid on their own.

    Raises:
        Implausible: for the first contradiction found.
    """
    if vehicle.whole_ship is not None:
        _check_said_once(vehicle)
        _check_size(vehicle, vehicle.whole_ship)
        _check_rudder(vehicle.whole_ship)
        _check_speed(vehicle, vehicle.whole_ship)
        _check_resistance(vehicle, vehicle.whole_ship)


def _check_said_once(vehicle: Vehicle) -> None:
    """The polynomials are all that acts in surge, sway and yaw by motion in the plane."""
    if vehicle.manoeuvring is not None:
        raise Implausible(
            "whole_ship",
            "together with [manoeuvring]",
            "both are the forces of the same hull, propeller and rudder",
            "give one of the two tables",
        )
    for field, value in _damping_in_the_plane(vehicle):
        raise Implausible(
            field,
            value,
            "the polynomials of whole_ship have the damping of surge, sway and yaw already",
            "leave it out, or 0",
        )


def _damping_in_the_plane(vehicle: Vehicle) -> Iterator[tuple[str, str]]:
    """Yield entries by which motion in the plane is damped in the plane, with their values."""
    damping = vehicle.damping
    for i in IN_THE_PLANE:
        for j in IN_THE_PLANE:
            if vehicle.linear_damping[i, j] != 0.0:
                yield "damping.linear", f"{vehicle.linear_damping[i, j]:.6g} in {MOTIONS[i]}"
        if vehicle.quadratic_damping[i] != 0.0:
            yield f"damping.quadratic.{i}", f"{vehicle.quadratic_damping[i]:.6g}"
    for number, coupling in enumerate(damping.couplings):
        force, velocity, _ = coupling.indices
        if force in IN_THE_PLANE and velocity in IN_THE_PLANE:
            yield f"damping.couplings.{number}", f"{coupling.force} by {coupling.velocity}"
    for number, blended in enumerate(damping.blended):
        if blended.index in IN_THE_PLANE:
            yield f"damping.blended.{number}", f"damping in {blended.axis}"
    for number, drag in enumerate(vehicle.cross_flow):
        if drag.plane == "sway":
            yield f"cross_flow.{number}", "drag in sway and yaw"


def _check_size(vehicle: Vehicle, ship: WholeShip) -> None:
    (low, high), size = SIZE_RANGE, vehicle.dimensions
    if not low * size.length <= ship.length <= high * size.length:
        raise Implausible(
            "whole_ship.length",
            ship.length,
            f"it does not fit dimensions with {size.length:.4g} m ({low:g} to {high:g} of it)",
            "give both in m",
        )
    if abs(ship.depth) > size.height:
        raise Implausible(
            "whole_ship.depth",
            ship.depth,
            f"it lies further from the body origin than the hull is high, {size.height:.4g} m",
            "give it in m, positive down",
        )
    slowest, fastest = (froude * math.sqrt(vehicle.gravity * ship.length) for froude in FROUDE_RANGE)
    if not slowest <= ship.service_speed <= fastest:
        raise Implausible(
            "whole_ship.service_speed",
            ship.service_speed,
            f"no ship of this length has it: {slowest:.3g} to {fastest:.3g} m/s do",
            "give it in m/s, not in knots",
        )


def _check_rudder(ship: WholeShip) -> None:
    slope, side = ship.yaw.get("d", 0.0), ship.rudder.positive_to
    if (slope > 0.0) != (side == "starboard") or slope == 0.0:
        raise Implausible(
            "whole_ship.yaw.d",
            slope,
            f"a positive angle of the rudder does not turn the ship to {side}, as whole_ship.rudder.positive_to has it",
            "check the sign of N'_d, or the side",
        )


def _check_speed(vehicle: Vehicle, ship: WholeShip) -> None:
    if ship.surge.get("0", 0.0) != 0.0:
        raise Implausible(
            "whole_ship.surge.0",
            ship.surge["0"],
            "with a constant force ahead the ship does not hold its service speed",
            "leave it out",
        )
    force = own_axis_force(vehicle, AHEAD)
    for speed, what, sign in ((ship.slowest, "driven ahead", 1.0), (ship.fastest, "held back", -1.0)):
        value = force(speed)
        if sign * value <= 0.0:
            raise Implausible(
                "whole_ship.surge",
                f"{value:.4g} N at {speed:.4g} m/s",
                f"the ship's service speed is {ship.service_speed:g} m/s, but it is not {what} there",
                "check the signs, X'_u is negative; or give a narrower whole_ship.range",
            )


def _check_resistance(vehicle: Vehicle, ship: WholeShip) -> None:
    fastest = {
        ACROSS: ship.service_speed * math.sin(math.radians(ship.range.drift_deg)),
        ROUND: ship.service_speed * ship.range.turn / ship.length,
    }
    for axis, speed in fastest.items():
        force = own_axis_force(vehicle, axis)
        for value in (speed, -speed):
            if value * force(value) >= 0.0:
                unit = "m/s" if axis == ACROSS else "rad/s"
                raise Implausible(
                    f"whole_ship.{MOTIONS[axis]}",
                    f"{force(value):.4g} at {value:.4g} {unit}",
                    f"the polynomials drive {MOTIONS[axis]} instead of resisting it",
                    "check the signs; the published derivatives Y'_v and N'_r are negative",
                )
