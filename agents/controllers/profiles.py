"""What is under and ahead of a vehicle as echoes tell of it: kept by dead reckoning, and smoothed by least squares."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.dead_reckoning import carried
from dq_marine.algebra.vector3 import Vector3

Array = NDArray[np.float64]

FARTHEST = 3.0
"""Echoes that are farther from a place than so many widths say nothing of it."""

STIFF, PLIANT = 1e-1, 1e-2
"""How many echoes that tell of no bend, and of no slope, are added: it is so where echoes are few."""


class Slope(NamedTuple):
    """The ground at a place: how far below the vehicle [m], and how steeply it falls ahead and to starboard."""

    below: float
    ahead: float
    starboard: float


class Line(NamedTuple):
    """A line that runs about along the bow, seen from above.

    Attributes:
        starboard: how far it is to starboard [m].
        slope: how far it goes to starboard per metre ahead.
        bend: how fast that grows [1/m].
    """

    starboard: float
    slope: float
    bend: float


class Echoed:
    """Points ahead, to starboard and below of the vehicle if it were level [m]."""

    def __init__(self, width: float, behind: float) -> None:
        """Take over what width points are smoothed, and how far behind the vehicle they are kept [m]."""
        self._width, self._behind = width, behind
        self.reset()

    def reset(self) -> None:
        """Forget all."""
        self._points = np.empty((0, 3))

    @property
    def empty(self) -> bool:
        """Whether nothing is known."""
        return not len(self._points)

    def move(self, way: Vector3, turn: float) -> None:
        """Tell how far a vehicle has gone ahead, to starboard and down [m], and turned to starboard [rad]."""
        moved = carried(self._points, way, turn)
        self._points = moved[moved[:, 0] >= -self._behind]

    def add(self, points: Array) -> None:
        """Take new points, shape (n, 3)."""
        self._points = np.concatenate([self._points, points])


class Ground(Echoed):
    """Echoes of the ground."""

    def at(self, ahead: float, starboard: float) -> Slope:
        """Return the ground at a place [m], by a plane that is bent along the bow through the echoes about there."""
        off = (self._points[:, :2] - (ahead, starboard)) / self._width
        squared = (off**2).sum(axis=1)
        nearest = float(self._points[squared.argmin(), 2])
        near = squared < FARTHEST**2
        x, y = off[near].T
        powers = np.stack([np.ones_like(x), x, y, x * x])
        depth, along, across, _ = _fitted(
            powers, squared[near], self._points[near, 2] - nearest, (PLIANT, PLIANT, STIFF)
        )
        return Slope(nearest + depth, along / self._width, across / self._width)


class Route(Echoed):
    """Points of a line that has been seen ahead."""

    def at(self, ahead: float) -> Line:
        """Return the line at a distance ahead [m], by a parabola through the points about there."""
        off = (self._points[:, 0] - ahead) / self._width
        squared = off**2
        nearest = float(self._points[squared.argmin(), 1])
        near = squared < FARTHEST**2
        x = off[near]
        starboard, slope, half_bend = _fitted(
            np.stack([np.ones_like(x), x, x * x]),
            squared[near],
            self._points[near, 1] - nearest,
            (PLIANT, STIFF),
        )
        return Line(nearest + starboard, slope / self._width, 2.0 * half_bend / self._width**2)


def _fitted(powers: Array, squared: Array, values: Array, stiffness: tuple[float, ...]) -> list[float]:
    """Return the coefficients of powers, shape (m, n), by least squares with weights that fall with a distance."""
    weighted = powers * np.exp(-0.5 * squared)
    normal = weighted @ powers.T + np.diag([0.01 * PLIANT, *stiffness])
    return [float(one) for one in np.linalg.solve(normal, weighted @ values)]
