"""The ground under and ahead of a vehicle as echoes tell of it: kept by dead reckoning, smoothed by a bent plane."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STIFFNESS = (1e-3, 1e-2, 1e-2, 1e-1)
"""How many echoes that tell of the nearest one's depth, of no slopes and no bend are added: it is so where few are."""

FARTHEST = 3.0
"""Echoes that are farther from a place than so many widths say nothing of it."""


class Slope(NamedTuple):
    """The ground at a place: how far below the vehicle [m], and how steeply it falls ahead and to starboard."""

    below: float
    ahead: float
    starboard: float


class Profile:
    """Echoes of the ground: points ahead, to starboard and below of the vehicle if it were level [m]."""

    def __init__(self, width: float, behind: float, expected: float) -> None:
        """Take over what width echoes are smoothed, how far behind they are kept, and the depth before any is [m]."""
        self._width, self._behind, self._expected = width, behind, expected
        self.reset()

    def reset(self) -> None:
        """Forget all."""
        self._points = np.empty((0, 3))

    def move(self, way: tuple[float, float, float], turn: float) -> None:
        """Tell how far a vehicle has gone ahead, to starboard and down [m], and turned to starboard [rad]."""
        c, s = math.cos(turn), math.sin(turn)
        ahead, starboard, below = (self._points - np.array(way)).T
        moved = np.column_stack([c * ahead + s * starboard, c * starboard - s * ahead, below])
        self._points = moved[moved[:, 0] >= -self._behind]

    def add(self, points: Array) -> None:
        """Take new echoes, shape (n, 3)."""
        self._points = np.concatenate([self._points, points])

    def at(self, ahead: float, starboard: float) -> Slope:
        """Return the ground at a place [m], by a plane that is bent along the bow through the echoes about there."""
        if not len(self._points):
            return Slope(self._expected, 0.0, 0.0)
        off = (self._points[:, :2] - (ahead, starboard)) / self._width
        squared = (off**2).sum(axis=1)
        nearest = float(self._points[squared.argmin(), 2])
        near = squared < FARTHEST**2
        x, y = off[near].T
        powers = np.stack([np.ones_like(x), x, y, x * x])
        weighted = powers * np.exp(-0.5 * squared[near])
        left = self._points[near, 2] - nearest
        depth, along, across, _ = np.linalg.solve(weighted @ powers.T + np.diag(STIFFNESS), weighted @ left)
        return Slope(nearest + float(depth), float(along) / self._width, float(across) / self._width)
