"""What beams have met, kept in the frame of the vehicle by dead reckoning, so that what they no longer see counts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.dead_reckoning import carried
from dq_marine.agents.controllers.fresh_readings import Fresh

Array = NDArray[np.float64]
Velocity = tuple[float, float, float]

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

    def move(self, way: tuple[float, float], turn: float, time: float) -> None:
        """Tell how far a vehicle has gone ahead and to starboard [m], and turned to starboard [rad], in a time [s]."""
        self._points = carried(self._points, way, turn)
        self._ages = self._ages + time

    def add(self, readings: Array, roll: float, pitch: float, fresh: Fresh, velocity: Velocity) -> None:
        """Take the readings that are fresh, and drop what is old or hidden.

        Args:
            readings: of the beams, shares of the reach.
            roll: of the vehicle [rad].
            pitch: of the vehicle [rad].
            fresh: which of the readings are, and since when.
            velocity: ahead and to starboard [m/s], and turning to starboard [rad/s]: what is told late has moved.
        """
        met = (readings < 1.0) & fresh.beams
        ahead, starboard = self._reach * readings * self._cosines, self._reach * readings * self._sines
        down = math.sin(roll) * starboard
        level = np.column_stack(
            [math.cos(pitch) * ahead + math.sin(pitch) * down, math.cos(roll) * starboard]
        )
        way = (fresh.age * velocity[0], fresh.age * velocity[1])
        new = carried(level[met], way, fresh.age * velocity[2])
        points = np.concatenate([new, self._points])
        ages = np.concatenate([np.full(len(new), fresh.age), self._ages])
        sectors = np.floor(np.arctan2(points[:, 1], points[:, 0]) / SECTOR)
        newest = np.unique(sectors, return_index=True)[1]
        newest = newest[ages[newest] <= self._lasting]
        self._points, self._ages = points[newest], ages[newest]
