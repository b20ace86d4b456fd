"""Places that an episode may begin at or lead to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

FARTHEST = 1e6
"""From the world's origin [m]: the Earth is not flat over more, and a double still resolves a nanometre there."""


def near_place(name: str, value: Any) -> NDArray[np.float64]:
    """Return a position in NED [m] as an array of shape (3,).

    Raises:
        InvalidInputError: it is not three finite numbers, or is farther away than `FARTHEST`.
    """
    place = finite_array(name, value, 3)
    if np.abs(place).max() > FARTHEST:
        raise InvalidInputError(
            f"{name} = {place.tolist()} is beyond {FARTHEST:g} m; give a place nearer to the world's origin"
        )
    return place


def goal_place(name: str, value: Any, vehicle: Vehicle) -> NDArray[np.float64]:
    """Return a goal's position in NED [m] as an array of shape (3,), where the vehicle is in the water.

    Raises:
        InvalidInputError: as for `near_place`, or it is up in the air.
    """
    place = near_place(name, value)
    highest = highest_goal(vehicle)
    if place[2] < highest:
        raise InvalidInputError(
            f"{name} = {place.tolist()} is up in the air (z points down); give a depth of {highest:g} m or more for "
            f"{vehicle.name}"
        )
    return place


def starting_depth(vehicle: Vehicle, least: float) -> float:
    """Return at what depth of its body origin a vehicle starts [m]: at rest if it floats, else where there is room.

    Room is ten lengths below the surface, and `least` or more [m].
    """
    if vehicle.hydrostatics is not None:
        return vehicle.equilibrium_depth
    return max(least, 10.0 * vehicle.dimensions.length)


def highest_goal(vehicle: Vehicle) -> float:
    """Return the least depth of the body origin at which a vehicle can be told to be [m].

    It is 0, the surface, for a vehicle whose model is always under water, and for one that floats, a height of its hull
    above where it is at rest: there the last of it leaves the water.
    """
    if vehicle.hydrostatics is None:
        return 0.0
    return vehicle.equilibrium_depth - vehicle.dimensions.height
