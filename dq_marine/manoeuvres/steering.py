"""Steering of a vehicle: carries out throttle, helm and planes."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.one_body import OneBody
from dq_marine.vehicles import Vehicle

SURGE, HEAVE, PITCH, YAW = 0, 2, 4, 5
"""Axes that orders are about, in Fossen's order."""


RUDDER = math.radians(35.0)
"""Deflection that full helm is taken for where no rudder says what it is [rad]: a ship's."""


class Order(NamedTuple):
    """The orders at one time.

    Attributes:
        throttle: of the thrust along x, -1 (full astern) to 1.
        helm: of what turns the vehicle, -1 (full to port) to 1 (full to starboard).
        heave_force: Z that is asked for [N].
        pitch_moment: M that is asked for [N m].
    """

    throttle: float
    helm: float
    heave_force: float = 0.0
    pitch_moment: float = 0.0


class Steering(Protocol):
    """Carries out orders."""

    @property
    def full_angle(self) -> float:
        """Deflection of full helm [rad]."""

    def full_moment(self, speed: float) -> float:
        """Return the yaw moment of full helm at a speed ahead [m/s], in N m."""

    def advance(self, body: OneBody, order: Order, surge_speed: float, steps: int) -> None:
        """Advance the body, that has a speed ahead [m/s], by `steps` steps under an order."""


class WrenchSteering:
    """Forces and moments on the body: throttle and helm are fractions of the vehicle's limits in surge and yaw."""

    def __init__(self, vehicle: Vehicle) -> None:
        """Take the vehicle's limits.

        Raises:
            InvalidInputError: the vehicle cannot be turned.
        """
        self._limits = vehicle.wrench_limits
        if self._limits[YAW] == 0.0:
            raise InvalidInputError(
                f"limits.wrench[{YAW}] = 0: {vehicle.name!r} has nothing in yaw to turn it; give it a limit above 0, "
                "or a vehicle that has one"
            )

    @property
    def full_angle(self) -> float:
        """Deflection that full helm stands for [rad]."""
        return RUDDER

    def full_moment(self, speed: float) -> float:
        """Return the limit in yaw [N m]."""
        return float(self._limits[YAW])

    def advance(self, body: OneBody, order: Order, surge_speed: float, steps: int) -> None:
        """Advance the body under an order, within the limits."""
        wrench = np.zeros(6)
        wrench[SURGE], wrench[YAW] = self._limits[SURGE] * order.throttle, self._limits[YAW] * order.helm
        wrench[HEAVE], wrench[PITCH] = order.heave_force, order.pitch_moment
        body.step(np.clip(wrench, -self._limits, self._limits), steps)
