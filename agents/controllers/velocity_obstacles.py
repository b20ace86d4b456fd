"""Which course to take among vessels that keep theirs: by velocity obstacles, with the sides that the rules ask for.

A course is in a velocity obstacle if one's own vessel, going that way, comes too near to another (Fiorini and Shiller 1998,
Motion planning in dynamic environments using velocity obstacles). Kuwata et al. (2014, Safe maritime autonomous navigation
with COLREGS, using velocity obstacles, IEEE J. Oceanic Eng. 39(1)) add a set for each vessel that one has to give way to: the
courses that pass it on the wrong side; and they take the course of least cost. A ship needs several lengths to turn, so
that it has not the velocity of a course at once: the way to it is an arc, as in the generalised velocity obstacles of Wilkie,
van den Berg and Manocha (2009). All is in units of one's own length and of the time in which that is gone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HORIZON, STEP = 45.0, 0.5
"""How far ahead ways are compared, and in what steps [own lengths gone]."""

LEAST, WIDEST, APART = math.radians(20.0), math.radians(100.0), math.radians(5.0)
"""Courses that are tried, besides those of the route: from this to this on both sides of it, and apart by this [rad].

Rule 8: an alteration of course shall be large enough to be readily apparent, not a succession of small ones.
"""

SPEEDS = (1.0, 0.5)
"""Speeds that are tried, over that of the route, by a vessel that can slow down."""

LAG = 1.0
"""Way before a vessel that goes straight begins to turn [own lengths]."""

LOOK_AHEAD = 5.0
"""Of the line of sight, back to the route [own lengths]."""

TOO_NEAR, NEAR = 2.2, 4.0
"""Distances to others that are avoided at any cost, and where possible [own lengths]."""

LASTING = 30.0
"""Courses off the route cost by the time until all others are past, over this [own lengths gone]."""

STAND_ON = 15.0
"""Rule 17: how long before it would be nearest one acts for a vessel that has to give way, and does not [own lengths gone]."""

ON_TOO_NEAR, ON_NEAR, ON_WRONG_SIDE, ON_DEVIATION, ON_PORT, ON_CHANGE = 1000.0, 30.0, 60.0, 10.0, 1.5, 4.0
"""Costs: of the share of both distances that is lacking; of a side; of courses off the route [1/rad], times this to port; and
of another course than before [1/rad]."""

ON_SLOWNESS, ON_SPEED_CHANGE = 16.0, 4.0
"""Costs of the speed that is lacking, and of another one than before, over that of the route."""


class Others(NamedTuple):
    """Other vessels: places [lengths], velocities over one's own speed, both along the route and to starboard, and rules.

    Attributes:
        places: from one's own, shape (k, 2).
        velocities: over ground, shape (k, 2).
        give_way: to which one has to give way, shape (k,).
        to_port: which have to be left to port, shape (k,).
    """

    places: Array
    velocities: Array
    give_way: NDArray[np.bool_]
    to_port: NDArray[np.bool_]


class Own(NamedTuple):
    """One's own vessel, in lengths and in the time of a length at the speed of the route.

    Attributes:
        course: over ground, from that of the route, to starboard [rad].
        speed: over that of the route.
        turning: turn rate of now [rad per length gone].
        fastest: turn rate of a hard turn [rad per length gone].
        braking: how fast the speed can be changed; 0 for a vessel that cannot slow down.
        starboard: cross-track error [lengths].
    """

    course: float
    speed: float
    turning: float
    fastest: float
    braking: float
    starboard: float


class Choice(NamedTuple):
    """What to do from now on: a course from that of the route [rad], None for back to it and along it; and a speed."""

    course: float | None
    speed: float


ON_ROUTE = Choice(None, 1.0)


def sight(starboard: float) -> float:
    """Return the course back to the route from a cross-track error [lengths]: the line of sight."""
    return -math.atan(starboard / LOOK_AHEAD)


class CourseChoice:
    """Chooses courses and speeds, one after the other."""

    def __init__(self) -> None:
        """Prepare the courses that are tried."""
        aside = np.arange(LEAST, WIDEST + 0.5 * APART, APART)
        self._courses = np.concatenate([[0.0], aside, -aside])
        self._times = STEP * np.arange(1, round(HORIZON / STEP) + 1)
        self._before = ON_ROUTE

    def reset(self) -> None:
        """Forget what was chosen."""
        self._before = ON_ROUTE

    def choose(self, own: Own, others: Others) -> Choice:
        """Return the course and the speed of least cost."""
        home, speeds = sight(own.starboard), SPEEDS if own.braking > 0.0 else SPEEDS[:1]
        commands = np.concatenate([[home], self._courses])
        before = home if self._before.course is None else self._before.course
        off = commands - home
        of_courses = ON_DEVIATION * np.where(off < 0.0, -ON_PORT * off, off)
        of_changes = ON_CHANGE * np.abs(commands - before)
        costs = np.zeros((len(speeds), len(commands)))
        for row, speed in zip(costs, speeds, strict=True):
            risk, lasting = self._risk(own, others, speed)
            row += risk + lasting * (of_courses + ON_SLOWNESS * (1.0 - speed))
            row += of_changes + ON_SPEED_CHANGE * abs(speed - self._before.speed)
        which, best = np.unravel_index(int(np.argmin(costs)), costs.shape)
        self._before = Choice(None if best == 0 else float(commands[best]), speeds[which])
        return self._before

    def _ways(self, own: Own, speed: float) -> tuple[Array, Array]:
        """Return courses over time, shape (1 + courses, times), and speeds, shape (times,).

        The first course goes back to the route and along it.
        """
        speeds = own.speed + np.clip(speed - own.speed, -own.braking * self._times, own.braking * self._times)
        gone = STEP * np.cumsum(speeds)
        back = -np.arctan(own.starboard / LOOK_AHEAD * np.exp(-gone / LOOK_AHEAD))
        wanted = np.vstack([back, np.broadcast_to(self._courses[:, None], (len(self._courses), len(back)))])
        turn = wanted - own.course
        begun = np.clip(np.sign(turn) * own.turning / own.fastest, 0.0, 1.0)
        reach = own.fastest * np.maximum(0.0, gone - LAG * (1.0 - begun))
        return own.course + np.clip(turn, -reach, reach), speeds

    def _risk(self, own: Own, others: Others, speed: float) -> tuple[Array, Array]:
        """Return the cost of coming near to others and of wrong sides, and how long the last is met, over `LASTING`.

        Both are of each course at a speed, shape (1 + courses,).
        """
        if not len(others.places):
            return np.zeros(1 + len(self._courses)), np.ones(1 + len(self._courses))
        ways, speeds = self._ways(own, speed)
        ahead, across = speeds * np.cos(ways), speeds * np.sin(ways)
        x = others.places[:, 0, None] + others.velocities[:, 0, None] * self._times
        y = others.places[:, 1, None] + others.velocities[:, 1, None] * self._times
        dx = x[None] - STEP * np.cumsum(ahead, axis=1)[:, None]
        dy = y[None] - STEP * np.cumsum(across, axis=1)[:, None]
        squares = dx * dx + dy * dy
        when = np.argmin(squares, axis=2)

        def there(values: Array) -> Array:
            return np.take_along_axis(values, when[..., None], axis=2)[..., 0]

        distance, time = np.sqrt(there(squares)), self._times[when]
        sideways_x = others.velocities[:, 0] - np.take_along_axis(ahead, when, axis=1)
        sideways_y = others.velocities[:, 1] - np.take_along_axis(across, when, axis=1)
        turning = there(dx) * sideways_y - there(dy) * sideways_x
        near = ON_NEAR * np.maximum(0.0, 1.0 - distance / NEAR)
        near += ON_TOO_NEAR * np.maximum(0.0, 1.0 - distance / TOO_NEAR)
        near = np.where(others.give_way | (time < STAND_ON), near, 0.0)
        wrong = others.to_port & (turning > 0.0) & (when > 0)
        risk = (near + np.where(wrong, ON_WRONG_SIDE, 0.0)).sum(axis=1)
        return risk, 0.5 + time.max(axis=1) / LASTING
