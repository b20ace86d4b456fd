"""Which way to go among points that are in the way: ways that turn and then run straight, and what they cost.

It is the dynamic window of Fox, Burgard & Thrun (1997, IEEE Robotics & Automation Magazine 4, 23) with the courses that
a vehicle can turn to in place of speeds: each is tried as an arc of its turning radius and a straight line after it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.settings import AvoidanceSettings

Array = NDArray[np.float64]

WIDEST_TURN, TURNS = math.radians(135.0), 55
"""The largest turn that is tried, to either side [rad], and how many turns are."""

SAMPLES = 24
"""Points of a way at which its room is measured."""


class Way(NamedTuple):
    """The way that is chosen: by how much to turn to starboard [rad], and how far it is free [m]."""

    turn: float
    free: float


class Ways:
    """The ways of a vehicle."""

    def __init__(self, settings: AvoidanceSettings, half_beam: float, length: float, radius: float) -> None:
        """Take half the beam, the length and the radius of turns [m]."""
        self._settings, self._half_beam, self._length = settings, half_beam, length
        self._turns = np.linspace(-WIDEST_TURN, WIDEST_TURN, TURNS)
        self._radius = radius

    def choose(self, points: Array, course: float, wanted: float, kept: float, horizon: float) -> Way:
        """Return the cheapest way.

        Args:
            points: in the way [m], ahead and to starboard, shape (n, 2).
            course: over ground, from the bow [rad].
            wanted: course to the goal, from the bow [rad].
            kept: course that was chosen last, from the bow [rad].
            horizon: how far ahead to look [m].
        """
        settings, courses = self._settings, course + self._turns
        room = self._room(points, course, horizon)
        nearest = float(np.hypot(points[:, 0], points[:, 1]).min()) if len(points) else math.inf
        # Where it is already closer than it should be, whatever leads no closer is as good as free.
        margin = min(self._half_beam + settings.margin * self._length, 0.95 * nearest)
        steps = np.linspace(0.0, horizon, SAMPLES + 1)[1:]
        blocked = room < margin
        free = np.where(blocked.any(axis=1), steps[blocked.argmax(axis=1)], horizon)
        spare = np.where(steps <= free[:, None], room, math.inf).min(axis=1) - margin
        cost = (
            np.abs(_wrapped(courses - wanted))
            + settings.blocked * (1.0 - free / horizon)
            + settings.nearness * np.exp(-np.maximum(spare, 0.0) / (settings.softness * self._length))
            + settings.hysteresis * np.abs(_wrapped(courses - kept))
        )
        best = int(cost.argmin())
        return Way(float(self._turns[best]), float(free[best]))

    def _room(self, points: Array, course: float, horizon: float) -> Array:
        """Return how far the nearest point is from each way, at each of its samples, shape (turns, samples)."""
        if not len(points):
            return np.full((TURNS, SAMPLES), math.inf)
        step = horizon / SAMPLES
        middles = step * (np.arange(SAMPLES) + 0.5)
        turned = np.sign(self._turns)[:, None] * np.minimum(
            np.abs(self._turns)[:, None], middles / self._radius
        )
        along, across = (
            np.cumsum(step * part, axis=1) for part in (np.cos(course + turned), np.sin(course + turned))
        )
        off = np.hypot(along[..., None] - points[:, 0], across[..., None] - points[:, 1])
        return np.asarray(off.min(axis=2))


def _wrapped(angles: Array) -> Array:
    return np.asarray((angles + math.pi) % (2.0 * math.pi) - math.pi)
