"""Steering of a ship with an MMG model: by its propeller and its rudder."""

from __future__ import annotations

import numpy as np

from dq_marine.algebra.spatial import Spatial
from dq_marine.manoeuvres.steering import Order
from dq_marine.physics.manoeuvring.build import stern_term
from dq_marine.physics.manoeuvring.tables import Manoeuvring
from dq_marine.simulation.one_body import OneBody


class RudderSteering:
    """Throttle is a share of the largest shaft speed, none astern; helm is a share of the largest rudder angle."""

    def __init__(self, tables: Manoeuvring, density: float) -> None:
        """Take the ship's tables and the density of the water [kg/m^3]."""
        self._speed_limit, self._angle_limit = tables.propeller.speed_limit, tables.rudder.limit
        self._stern = stern_term(tables, density)

    @property
    def full_angle(self) -> float:
        """Largest rudder angle [rad]."""
        return self._angle_limit

    def full_moment(self, speed: float) -> float:
        """Return the yaw moment of full helm at a speed ahead [m/s] and the largest shaft speed [N m]."""
        values, straight = (
            (self._speed_limit, (self._angle_limit, ())),
            Spatial((0.0, 0.0, 0.0), (speed, 0.0, 0.0)),
        )
        return self._stern.wrench(self._stern.numbers, values, straight).angular[2]

    def advance(self, body: OneBody, order: Order, surge_speed: float, steps: int) -> None:
        """Advance the body under an order; a throttle astern stops the shaft."""
        body.actuate(
            np.array([max(0.0, order.throttle) * self._speed_limit, order.helm * self._angle_limit]), steps
        )
