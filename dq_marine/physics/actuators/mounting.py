"""Where the forces of a vehicle's actuators act, and how large each is: for those who look at it, not for the step."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import Spatial
from dq_marine.physics.actuators.formulas.effects import EffectKind

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

STERN = -0.5
"""Where the rudder of a whole ship is drawn, as its polynomials do not say [lengths]."""


def mounting_points(vehicle: Vehicle) -> Array:
    """Return where the forces of actuators act in body axes, in the order of `actuator_parts`, shape (n, 3) [m]."""
    actuators = vehicle.actuators
    points: list[Any] = [thruster.position for thruster in actuators.thrusters]
    points += [azimuth.position for azimuth in actuators.azimuths]
    points += [nearest_point_of_action(np.array(fin.coefficients)) for fin in actuators.fins]
    if (ship := actuators.manoeuvring) is not None:
        points.append((ship.rudder.position * ship.length, 0.0, ship.rudder.depth))
    if (whole := actuators.whole_ship) is not None:
        points.append((STERN * whole.length, 0.0, whole.depth))
    return np.array(points, dtype=float).reshape(-1, 3)


def nearest_point_of_action(wrench: Array) -> Array:
    """Return the point, nearest to the origin, on the line along which a wrench's force acts, shape (3,) [m].

    With the force F and the moment M it is F x M / |F|^2; the origin for a wrench without force.
    """
    force, moment = wrench[:3], wrench[3:]
    square = float(force @ force)
    return np.cross(force, moment) / square if square > 0.0 else np.zeros(3)


def each_force(effects: Iterable[EffectKind], parameters: Any, values: Any, twist: Spatial) -> Array:
    """Return the force of each actuator in the body frame, shape (n, 3) [N].

    Args:
        effects: what each actuator does.
        parameters: of these effects, nested.
        values: of all channels, nested.
        twist: of the body, relative to the water.
    """
    forces = []
    for effect in effects:
        forces.append(effect.wrench(parameters[0], values, twist).linear)
        parameters = parameters[1]
        for _ in range(effect.channels):
            values = values[1]
    return np.array(forces, dtype=float).reshape(-1, 3)
