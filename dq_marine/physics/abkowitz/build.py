"""From a vehicle's polynomials to the pure functions and numbers of a step; nothing for a vehicle without."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.nesting import nested
from dq_marine.algebra.spatial import Spatial, from_fossen, to_fossen
from dq_marine.physics.abkowitz.formulas.ship import (
    HullAndMass,
    MotionRange,
    PlanarMass,
    Products,
    Ship,
    make_ship_hull,
    make_ship_rudder,
)
from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.physics.term import ForceTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

NAME = "whole ship"
"""Name of the force among a scene's terms."""

AHEAD, ACROSS, ROUND = 0, 1, 5
"""Surge, sway and yaw in Fossen's order."""

AT_ORIGIN = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""A pose, of which the polynomials know nothing."""


class RudderTerm(NamedTuple):
    """A rudder: (numbers, channel's value, twist) -> wrench, and the numbers."""

    wrench: Callable[[Ship, Any, Spatial], Spatial]
    numbers: Ship


def whole_ship_terms(vehicle: Vehicle) -> tuple[ForceTerm, ...]:
    """Return the force of a ship with its rudder amidships; none of a vehicle without polynomials."""
    if vehicle.whole_ship is None:
        return ()
    products, ship = _part(vehicle.whole_ship, vehicle.buoyancy.water_density, with_rudder=False)
    numbers = HullAndMass(ship, planar_mass(vehicle))
    return (ForceTerm(NAME, make_ship_hull(products), numbers, uses_velocity=True),)


def rudder_term(tables: WholeShip, density: float) -> RudderTerm:
    """Return what the rudder adds in water of a density [kg/m^3]."""
    products, ship = _part(tables, density, with_rudder=True)
    return RudderTerm(make_ship_rudder(products), ship)


def own_axis_force(vehicle: Vehicle, axis: int) -> Callable[[float], float]:
    """Return the force of motion along or about one axis alone [N, N m], rudder amidships; 0 of heave, roll, pitch.

    In surge it is the propeller's, too, and drives a ship ahead that is slower than its service speed. It is 0 of a
    vehicle without polynomials.
    """
    terms = whole_ship_terms(vehicle) if axis in (AHEAD, ACROSS, ROUND) else ()

    def force(speed: float) -> float:
        velocity = [0.0] * 6
        velocity[axis] = speed
        return sum(
            float(to_fossen(term.function(term.parameters, AT_ORIGIN, from_fossen(velocity), 0.0))[axis])
            for term in terms
        )

    return force


def planar_mass(vehicle: Vehicle) -> PlanarMass:
    """Return the entries of M for surge, sway and yaw."""
    m = vehicle.mass_matrix
    return PlanarMass(
        float(m[AHEAD, AHEAD]),
        float(m[ACROSS, ACROSS]),
        float(m[ROUND, ROUND]),
        float(m[AHEAD, ACROSS]),
        float(m[AHEAD, ROUND]),
        float(m[ACROSS, ROUND]),
    )


def _part(tables: WholeShip, density: float, *, with_rudder: bool) -> tuple[Products, Ship]:
    """Return the products and numbers of the polynomials that are not 0: with the rudder's angle, or without."""
    sign = 1.0 if tables.rudder.positive_to == "starboard" else -1.0

    def chosen(derivatives: Mapping[str, float]) -> dict[str, float]:
        return {
            letters.replace("0", ""): value * sign ** letters.count("d")
            for letters, value in derivatives.items()
            if value != 0.0 and ("d" in letters) == with_rudder
        }

    surge, sway, yaw = map(chosen, (tables.surge, tables.sway, tables.yaw))
    known, length = tables.range, tables.length
    ship = Ship(
        tables.service_speed,
        length,
        0.5 * density * length * length,
        tables.depth,
        MotionRange(known.loss, known.gain, math.sin(math.radians(known.drift_deg)), known.turn),
        nested(list(surge.values())),
        nested(list(sway.values())),
        nested(list(yaw.values())),
    )
    return Products(tuple(surge), tuple(sway), tuple(yaw)), ship
