"""What a vehicle's actuators can do, as a box: the wrench is linear in shares of their limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]


class ActuatorBox(NamedTuple):
    """The wrench is `matrix` times shares that lie within bounds.

    Attributes:
        matrix: wrench of each actuator at its limit, Fossen's order, shape (6, n) [N, N m].
        low: least share of each, shape (n,).
        high: largest share of each, shape (n,).
    """

    matrix: Array
    low: Array
    high: Array


def actuator_box(vehicle: Vehicle, actuation: str) -> ActuatorBox:
    """Return the box of an environment's actuation.

    Thrusters on fixed axes are each within their own limits. Where wrenches are commanded, or something turns or lives
    on the vehicle's speed, each axis is within its own.
    """
    limits, actuators = vehicle.wrench_limits, vehicle.actuators
    if actuation == "thrusters" and actuators.thrusters and not (actuators.azimuths or actuators.fins):
        low, high = np.array([thruster.thrust_range for thruster in actuators.thrusters]).T
        largest = np.maximum(np.abs(low), np.abs(high))
        driven = (limits > 0.0)[:, None]
        return ActuatorBox(driven * actuators.thrust_matrix * largest, low / largest, high / largest)
    axes = np.flatnonzero(limits)
    ones = np.ones(len(axes))
    return ActuatorBox(np.diag(limits)[:, axes], -ones, ones)
