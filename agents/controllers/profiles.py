"""The ground under and ahead of a vehicle as echoes tell of it: kept by dead reckoning, and smoothed by a parabola."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STIFFNESS = (1e-3, 1e-2, 1e-1)
"""How many echoes that tell of the nearest one's depth, of no slope and of no bend are added: it is so where few are."""

FARTHEST = 3.0
"""Echoes that are farther from a place than so many widths say nothing of it."""


class Slope(NamedTuple):
    """The ground at a place: how far below the vehicle [m], and how steeply it falls ahead."""

    below: float
    fall: float


class Profile:
    """Echoes of the ground in the vertical plane of the bow [m], ahead and below of the vehicle if it were level."""

    def __init__(self, width: float, behind: float, expected: float) -> None:
        """Take over what width echoes are smoothed, how far behind they are kept, and the depth before any is [m]."""
        self._width, self._behind, self._expected = width, behind, expected
        self.reset()

    def reset(self) -> None:
        """Forget all."""
        self._ahead, self._below = np.empty(0), np.empty(0)

    def move(self, ahead: float, down: float) -> None:
        """Tell how far a vehicle has gone [m]."""
        kept = self._ahead - ahead >= -self._behind
        self._ahead, self._below = self._ahead[kept] - ahead, self._below[kept] - down

    def add(self, ahead: Array, below: Array) -> None:
        """Take new echoes, each of shape (n,) [m]."""
        self._ahead = np.concatenate([self._ahead, ahead])
        self._below = np.concatenate([self._below, below])

    def at(self, ahead: float) -> Slope:
        """Return the ground at a distance ahead [m], by a parabola through the echoes about there."""
        if not len(self._ahead):
            return Slope(self._expected, 0.0)
        off = (self._ahead - ahead) / self._width
        nearest = float(self._below[np.abs(off).argmin()])
        near = np.abs(off) < FARTHEST
        off = off[near]
        powers = np.stack([np.ones_like(off), off, off * off])
        weighted = powers * np.exp(-0.5 * off * off)
        depth, fall, _ = np.linalg.solve(
            weighted @ powers.T + np.diag(STIFFNESS), weighted @ (self._below[near] - nearest)
        )
        return Slope(nearest + float(depth), float(fall) / self._width)
