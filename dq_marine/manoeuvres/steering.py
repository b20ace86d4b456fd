"""How a vehicle is steered: from throttle and helm to what acts on it."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from dq_marine.engines.one_body import OneBody
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import Vehicle


class Order(NamedTuple):
    """What is asked for at one time.

    Attributes:
        throttle: of the thrust along x, -1 (full astern) to 1.
        helm: of what turns the vehicle, -1 (full to port) to 1 (full to starboard).
        heave_force: Z that the depth keeper asks for [N].
        pitch_moment: M that it asks for [N m].
    """

    throttle: float
    helm: float
    heave_force: float = 0.0
    pitch_moment: float = 0.0


class Steering(Protocol):
    """Carries out orders."""

    def advance(self, body: OneBody, order: Order, steps: int) -> None:
        """Advance the body by `steps` steps under an order."""


class WrenchSteering:
    """Forces and moments on the body: throttle and helm are fractions of the vehicle's limits in surge and yaw."""

    def __init__(self, vehicle: Vehicle) -> None:
        """Take the vehicle's limits.

        Raises:
            InvalidInputError: the vehicle cannot be driven ahead or turned.
        """
        self._limits = vehicle.wrench_limits
        for axis, name, purpose in ((0, "surge", "drive it ahead"), (5, "yaw", "turn it")):
            if self._limits[axis] == 0.0:
                raise InvalidInputError(
                    f"limits.wrench[{axis}] = 0: {vehicle.name!r} has nothing in {name} to {purpose}; give it a limit "
                    "above 0, or a vehicle that has one"
                )

    def advance(self, body: OneBody, order: Order, steps: int) -> None:
        """Advance the body by `steps` steps under an order."""
        surge, _, heave, _, pitch, yaw = self._limits
        wrench = np.array(
            [
                surge * order.throttle,
                0.0,
                min(max(order.heave_force, -heave), heave),
                0.0,
                min(max(order.pitch_moment, -pitch), pitch),
                yaw * order.helm,
            ]
        )
        body.step(wrench, steps)
