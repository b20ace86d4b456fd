"""From a vehicle's MMG tables to the pure functions and numbers of a step; nothing for a vehicle without."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from dq_marine.algebra.spatial import Spatial
from dq_marine.physics.manoeuvring.formulas.hull import (
    HullMotion,
    LateralPolynomial,
    ManoeuvringHull,
    PolynomialRange,
    SurgePolynomial,
    manoeuvring_hull,
    surge_force,
    sway_force,
    yaw_moment,
)
from dq_marine.physics.manoeuvring.formulas.stern import (
    ShipPropeller,
    ShipRudder,
    Stern,
    ThrustCurve,
    make_stern_wrench,
)
from dq_marine.physics.manoeuvring.formulas.wake import (
    GaussianWake,
    TwoConstantsWake,
    gaussian_inflow,
    two_constants_inflow,
)
from dq_marine.physics.manoeuvring.tables import LateralTable, Manoeuvring, PropellerTable, TwoConstants
from dq_marine.physics.term import ForceTerm

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

NAME = "manoeuvring hull"
"""Name of the hull's force among a scene's terms."""


class SternTerm(NamedTuple):
    """Propeller and rudder: (numbers, channels' values, twist) -> wrench, and the numbers."""

    wrench: Callable[[Stern, Any, Spatial], Spatial]
    numbers: Stern


def manoeuvring_terms(vehicle: Vehicle) -> tuple[ForceTerm, ...]:
    """Return the force of the hull; none of a vehicle without an MMG model."""
    if vehicle.manoeuvring is None:
        return ()
    return (
        ForceTerm(NAME, manoeuvring_hull, hull_numbers(vehicle, vehicle.manoeuvring), uses_velocity=True),
    )


def hull_numbers(vehicle: Vehicle, tables: Manoeuvring) -> ManoeuvringHull:
    """Return the numbers of a hull."""
    surge, hull, added = tables.hull.surge, tables.hull, vehicle.added_mass_matrix
    drift = math.radians(hull.drift_limit_deg)
    return ManoeuvringHull(
        SurgePolynomial(surge.resistance, surge.vv, surge.vr, surge.rr, surge.vvvv),
        _lateral(hull.sway),
        _lateral(hull.yaw),
        PolynomialRange(math.sin(drift), math.cos(drift), hull.turn_limit),
        tables.length,
        0.5 * vehicle.buoyancy.water_density * tables.length * tables.draft,
        float(added[1, 1] - added[0, 0]),
        float(added[0, 1]),
        hull.depth,
    )


def own_axis_drag(vehicle: Vehicle, axis: int) -> float:
    """Return q of the force -q |nu| nu against motion along or about one axis alone [N s^2/m^2, N m s^2]."""
    if vehicle.manoeuvring is None:
        return 0.0
    hull = hull_numbers(vehicle, vehicle.manoeuvring)
    drift, turn, length = hull.validity.drift, hull.validity.turn, hull.length
    if axis == 0:
        return -hull.pressure * surge_force(hull.surge, HullMotion(1.0, 1.0, 0.0, 0.0))
    if axis == 1:
        return -hull.pressure * sway_force(hull.sway, HullMotion(1.0, 0.0, drift, 0.0))
    if axis == 5:
        moment = hull.pressure * length * yaw_moment(hull.yaw, HullMotion(1.0, 0.0, 0.0, turn))
        return -moment * (length / turn) ** 2
    return 0.0


def stern_term(tables: Manoeuvring, density: float) -> SternTerm:
    """Return propeller and rudder in water of a density [kg/m^3]."""
    propeller, rudder, length = tables.propeller, tables.rudder, tables.length
    inflow, wake = _wake(propeller)
    numbers = Stern(
        ShipPropeller(
            ThrustCurve(*propeller.thrust),
            wake,
            propeller.diameter,
            1.0 - propeller.deduction,
            propeller.position,
            density,
            propeller.depth,
        ),
        ShipRudder(
            0.5 * density * rudder.area * rudder.lift_slope,
            propeller.diameter / rudder.height,
            rudder.acceleration,
            rudder.inflow,
            rudder.straightening_positive,
            rudder.straightening_negative,
            rudder.lever,
            1.0 - rudder.surge_deduction,
            1.0 + rudder.sway_increase,
            (rudder.position + rudder.sway_increase * rudder.increase_position) * length,
            rudder.depth,
        ),
        length,
        tables.hull.turn_limit,
    )
    return SternTerm(make_stern_wrench(inflow), numbers)


def _wake(propeller: PropellerTable) -> tuple[Callable[[Any, float], float], TwoConstantsWake | GaussianWake]:
    """Return the function of a wake and its numbers."""
    wake = propeller.wake
    if isinstance(wake, TwoConstants):
        return two_constants_inflow, TwoConstantsWake(
            1.0 - wake.straight, wake.growth, wake.most_positive, wake.most_negative
        )
    return gaussian_inflow, GaussianWake(wake.straight, wake.decay)


def _lateral(table: LateralTable) -> LateralPolynomial:
    return LateralPolynomial(table.v, table.r, table.vvv, table.vvr, table.vrr, table.rrr)
