"""Steering of a ship whose propeller and rudder are in its polynomials: by the rudder's angle alone."""

from __future__ import annotations

import numpy as np

from dq_marine.algebra.spatial import Spatial
from dq_marine.manoeuvres.steering import Order
from dq_marine.physics.abkowitz.build import rudder_term
from dq_marine.physics.abkowitz.tables import WholeShip
from dq_marine.simulation.one_body import OneBody


class WholeShipSteering:
    """Helm is a share of the largest rudder angle; the throttle is always full, and its other actuators rest."""

    def __init__(self, tables: WholeShip, density: float, channels: int) -> None:
        """Take the ship's tables, the density of the water [kg/m^3], and how many channels: the last is the rudder."""
        self._angle_limit = tables.rudder.limit
        self._rudder = rudder_term(tables, density)
        self._channels = channels

    @property
    def full_angle(self) -> float:
        """Largest rudder angle [rad]."""
        return self._angle_limit

    def full_moment(self, speed: float) -> float:
        """Return the yaw moment of full helm at a speed ahead [m/s], in N m."""
        straight = Spatial((0.0, 0.0, 0.0), (speed, 0.0, 0.0))
        return self._rudder.wrench(self._rudder.numbers, (self._angle_limit, ()), straight).angular[2]

    def advance(self, body: OneBody, order: Order, surge_speed: float, steps: int) -> None:
        """Advance the body under an order."""
        command = np.zeros(self._channels)
        command[-1] = order.helm * self._angle_limit
        body.actuate(command, steps)
