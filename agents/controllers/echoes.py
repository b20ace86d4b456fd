"""What beams have met, kept in the frame of the vehicle by dead reckoning, so that what they no longer see counts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import Attitude
from dq_marine.agents.controllers.dead_reckoning import carried, gone
from dq_marine.agents.controllers.fresh_readings import Fresh

Array = NDArray[np.float64]

SECTOR = math.radians(5.0)
"""Of each sector round the vehicle, only the newest echo is kept [rad]."""


class Echoes:
    """Points ahead and to starboard of a level vehicle [m]."""

    def __init__(self, bearings: Array, reach: float, lasting: float) -> None:
        """Take the bearings of the beams [rad], their reach [m] and how long an echo counts [s]."""
        self._cosines, self._sines = np.cos(bearings), np.sin(bearings)
        self._reach, self._lasting = reach, lasting
        self.reset()

    def reset(self) -> None:
        """Forget all."""
        self._points, self._ages = np.empty((0, 2)), np.empty(0)

    @property
    def points(self) -> Array:
        """Where echoes are now, shape (n, 2)."""
        return self._points

    def move(self, attitude: Attitude, time: float) -> None:
        """Tell that a vehicle has gone for a time [s] as its attitude says."""
        self._points = carried(self._points, *gone(attitude, time))
        self._ages = self._ages + time

    def add(self, readings: Array, fresh: Fresh, attitude: Attitude) -> None:
        """Take the readings that are fresh, and drop what is old or hidden.

        Args:
            readings: of the beams, shares of the reach.
            fresh: which of the readings are, and since when: what is told late has moved.
            attitude: of the vehicle.
        """
        roll, pitch = attitude.roll, attitude.pitch
        met = (readings < 1.0) & fresh.beams
        ahead, starboard = self._reach * readings * self._cosines, self._reach * readings * self._sines
        down = math.sin(roll) * starboard
        level = np.column_stack(
            [math.cos(pitch) * ahead + math.sin(pitch) * down, math.cos(roll) * starboard]
        )
        new = carried(level[met], *gone(attitude, fresh.age))
        points = np.concatenate([new, self._points])
        ages = np.concatenate([np.full(len(new), fresh.age), self._ages])
        sectors = np.floor(np.arctan2(points[:, 1], points[:, 0]) / SECTOR)
        newest = np.unique(sectors, return_index=True)[1]
        newest = newest[ages[newest] <= self._lasting]
        self._points, self._ages = points[newest], ages[newest]
