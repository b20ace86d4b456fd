"""Which course to take among vessels that keep theirs: by velocity obstacles, with the sides that the rules ask for.

A course is in a velocity obstacle if one's own vessel, going that way, comes too near to another (Fiorini and
Shiller 1998, Motion planning in dynamic environments using velocity obstacles). Kuwata et al. (2014, Safe maritime
autonomous navigation with COLREGS, using velocity obstacles, IEEE J. Oceanic Eng. 39(1)) add a set for each vessel
that one has to give way to: the courses that pass it on the wrong side; and they take the course of least cost. A
ship needs several lengths to turn, so that it has not the velocity of a course at once: the way to it is an arc, as
in the generalised velocity obstacles of Wilkie, van den Berg and Manocha (2009). All is in units of one's own
length and of the time in which that is gone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.ways_among_vessels import (
    Distances,
    Others,
    Own,
    compiled_comparison,
    sight,
)

Array = NDArray[np.float64]

LEAST, WIDEST, APART = math.radians(20.0), math.radians(100.0), math.radians(5.0)
"""Courses that are tried, besides those of the route: from this to this on both sides of it, and apart by this [rad].

Rule 8: an alteration of course shall be large enough to be readily apparent, not a succession of small ones.
"""

SPEEDS = (1.0, 0.5)
"""Speeds that are tried, over that of the route, by a vessel that can slow down."""

BEYOND_SAFE = Distances(too_near=0.7, near=2.5, free=1.5)
"""Distances to others, over the one that they must not come nearer than [own lengths]."""

LASTING = 15.0
"""Courses off the route cost by the time until the way back is free, over this [own lengths gone]."""

ON_DEVIATION, ON_PORT, ON_CHANGE = 10.0, 1.5, 4.0
"""Costs: of courses off the route [1/rad], times this to port; and of another course than before [1/rad]."""

ON_SLOWNESS, ON_SPEED_CHANGE = 16.0, 4.0
"""Costs of the speed that is lacking, and of another one than before, over that of the route."""


class Choice(NamedTuple):
    """What to do from now on: a course from that of the route [rad], None for back to it and along it; and a speed."""

    course: float | None
    speed: float


ON_ROUTE = Choice(None, 1.0)


class CourseChoice:
    """Chooses courses and speeds, one after the other."""

    def __init__(self, safe_distance: float) -> None:
        """Take the distance that others must not come nearer than [own lengths], and prepare the courses to try."""
        aside = np.arange(LEAST, WIDEST + 0.5 * APART, APART)
        self._courses = np.concatenate([[0.0], aside, -aside])
        self._distances = Distances(*(safe_distance + beyond for beyond in BEYOND_SAFE))
        self._compare = compiled_comparison()
        self._before = ON_ROUTE

    def reset(self) -> None:
        """Forget what was chosen."""
        self._before = ON_ROUTE

    def choose(self, own: Own, others: Others) -> Choice:
        """Return the course and the speed of least cost."""
        home, speeds = sight(own.starboard), SPEEDS if own.braking > 0.0 else SPEEDS[:1]
        commands = np.concatenate([[home], self._courses])
        off = commands - home
        of_courses = ON_DEVIATION * np.where(off < 0.0, -ON_PORT * off, off)
        costs = self._of_changes(commands, np.array(speeds))
        risk, lasting = np.empty(len(commands)), np.empty(len(commands))
        for row, speed in zip(costs, speeds, strict=True):
            self._compare(own, speed, self._courses, others, self._distances, risk, lasting)
            row += risk + (0.2 + lasting / LASTING) * (of_courses + ON_SLOWNESS * (1.0 - speed))
        which, best = np.unravel_index(int(np.argmin(costs)), costs.shape)
        self._before = Choice(None if best == 0 else float(commands[best]), speeds[which])
        return self._before

    def _of_changes(self, commands: Array, speeds: Array) -> Array:
        """Return the cost of doing another thing than before, of each speed and course, shape (speeds, courses)."""
        before = commands[0] if self._before.course is None else self._before.course
        of_speeds = ON_SPEED_CHANGE * np.abs(speeds - self._before.speed)
        costs: Array = ON_CHANGE * np.abs(commands - before) + of_speeds[:, None]
        costs[0, 0] = (
            0.0  # to go back to the route at its speed never costs: as soon as it is free, it is taken
        )
        return costs
