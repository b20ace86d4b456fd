"""Where a controller's wrench goes: to the body itself, or to the vehicle's actuators by thrust allocation."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]


class Given(NamedTuple):
    """What a wanted wrench becomes: the wrench that the body gets, shape (6,), and the action for it, shape (n,)."""

    wrench_body: Array
    action: Array


class WrenchMapping(Protocol):
    """Turns wrenches into actions."""

    def give(self, wanted: Array, surge_speed: float) -> Given:
        """Return what comes nearest to a wrench, in Fossen's order, at a surge velocity [m/s]."""


class AxesMapping:
    """Each axis has its own actuator, and its own limit."""

    def __init__(self, vehicle: Vehicle) -> None:
        """Take the vehicle's limits."""
        self._limits = vehicle.wrench_limits
        self._actuated = np.flatnonzero(self._limits)

    def give(self, wanted: Array, surge_speed: float) -> Given:
        """Return the wrench within the limits."""
        given = np.clip(wanted, -self._limits, self._limits)
        return Given(given, given[self._actuated] / self._limits[self._actuated])


class ActuatorsMapping:
    """The vehicle's thrusters, azimuths and fins share the wrench; their lags are not known to the controller.

    Each axis asks for no more than its limit: what a far goal wants of one would else be taken from the others, and the
    integral would wind up against that.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        """Prepare the allocation.

        Raises:
            InvalidInputError: the vehicle has no actuators whose force is known.
            MissingDependencyError: SciPy is not installed.
        """
        from dq_marine.physics.actuators.allocation import ThrustAllocator  # here: it imports SciPy

        self._limits = vehicle.wrench_limits
        self._allocator = ThrustAllocator(vehicle)

    def give(self, wanted: Array, surge_speed: float) -> Given:
        """Return what the actuators can do."""
        asked = np.clip(wanted, -self._limits, self._limits)
        allocation = self._allocator.allocate(asked, surge_speed=surge_speed)
        return Given(allocation.wrench_body, allocation.action)


WRENCH_MAPPINGS: dict[str, Callable[[Vehicle], WrenchMapping]] = {
    "wrench": AxesMapping,
    "thrusters": ActuatorsMapping,
}
"""By the name of the actuation that an environment is made with."""
