"""Line of sight along a path in space: from a place beside it to what an autopilot is to do."""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.agents.controllers.autopilot import PITCH, YAW, Array, Attitude, Autopilot, Order
from dq_marine.agents.controllers.guidance import AdaptiveSight, levelled
from dq_marine.agents.settings import AutopilotSettings


class Offset(NamedTuple):
    """How far a vehicle is to starboard of a path, and below it [m]."""

    starboard: float
    below: float


class LineOfSight:
    """Adaptive line of sight, level and vertical, for an autopilot: from a place beside a path to its orders."""

    def __init__(self, pilot: Autopilot, settings: AutopilotSettings) -> None:
        """Take the autopilot that is to carry the orders out."""
        self._pilot, self._settings = pilot, settings
        self._sights: tuple[AdaptiveSight, AdaptiveSight] | None = None

    def reset(self) -> None:
        """Forget the path before."""
        self._sights = None

    def order(
        self, attitude: Attitude, speed: float, ahead_body: Array, bend_body: Array, off: Offset
    ) -> Order:
        """Return the order for a speed along a path [m/s].

        Args:
            attitude: of the vehicle.
            speed: wanted over ground.
            ahead_body: where the path goes, a unit vector, shape (3,).
            bend_body: its curvature [1 / vehicle length], shape (3,).
            off: how far the vehicle is to starboard of the path and below it [m].
        """
        way = levelled(tuple(ahead_body.tolist()), attitude.roll, attitude.pitch)
        bend = levelled(tuple(bend_body.tolist()), attitude.roll, attitude.pitch)
        return self.level_order(attitude, speed, way, bend, off)

    def level_order(
        self,
        attitude: Attitude,
        speed: float,
        way: tuple[float, float, float],
        bend: tuple[float, float, float],
        off: Offset,
    ) -> Order:
        """Return the order, as `order` does, for vectors ahead, to starboard and down of a level vehicle."""
        along = math.hypot(way[0], way[1])
        turning = speed * (way[0] * bend[1] - way[1] * bend[0]) / along / self._pilot.length
        return self.order_along(attitude, speed, way, turning, off)

    def order_along(
        self,
        attitude: Attitude,
        speed: float,
        way: tuple[float, float, float],
        turning: float,
        off: Offset,
    ) -> Order:
        """Return the order for a speed along a path [m/s].

        Args:
            attitude: of the vehicle.
            speed: wanted over ground.
            way: where the path goes, ahead, to starboard and down of the vehicle if it were level.
            turning: how fast the path's course turns to starboard at that speed [rad/s].
            off: how far the vehicle is to starboard of the path and below it [m].
        """
        level, upright = self._sights or self._make_sights(speed)
        along = math.hypot(way[0], way[1])
        course = math.atan2(way[1], way[0]) + level.correction(off.starboard, speed)
        climb = math.atan2(-way[2], along) + upright.correction(-off.below, speed)
        return Order(speed, speed - attitude.speed, course - attitude.drift_angle, turning, climb)

    def _make_sights(self, speed: float) -> tuple[AdaptiveSight, AdaptiveSight]:
        """Return the laws for both planes, at a speed."""
        pilot, settings = self._pilot, self._settings
        axes = (YAW, PITCH if pilot.dives and not pilot.by_heave else YAW)
        turn, tilt = (
            AdaptiveSight(
                pilot.look_ahead(speed, axis), settings.adaptation, settings.largest_drift_angle, pilot.period
            )
            for axis in axes
        )
        self._sights = (turn, tilt)
        return self._sights
