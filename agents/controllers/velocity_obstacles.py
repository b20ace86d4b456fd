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

WIDEST, APART = math.radians(100.0), math.radians(5.0)
"""Courses that are tried: up to this on both sides of the route, and apart by this [rad]."""

LAG = 1.0
"""Way before a vessel that goes straight begins to turn [own lengths]."""

LOOK_AHEAD = 5.0
"""Of the line of sight, back to the route [own lengths]."""

TOO_NEAR, NEAR = 2.2, 4.0
"""Distances to others that are avoided at any cost, and where possible [own lengths]."""

STAND_ON = 15.0
"""Rule 17: how long before it would be nearest one acts for a vessel that has to give way, and does not [own lengths gone]."""

ON_TOO_NEAR, ON_NEAR, ON_WRONG_SIDE, ON_DEVIATION, ON_PORT, ON_CHANGE = 1000.0, 30.0, 60.0, 10.0, 1.5, 4.0
"""Costs: of the share of both distances that is lacking; of a side; of courses off the route [1/rad], times this to port; and
of another course than before [1/rad]."""


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
    """One's own vessel: course from that of the route [rad], turn rate and largest one [rad per length], cross-track error.

    Attributes:
        course: over ground, from that of the route, to starboard.
        turning: rate of now.
        fastest: rate of a hard turn.
        starboard: of the route [lengths].
    """

    course: float
    turning: float
    fastest: float
    starboard: float


def sight(starboard: float) -> float:
    """Return the course back to the route from a cross-track error [lengths]: the line of sight."""
    return -math.atan(starboard / LOOK_AHEAD)


class CourseChoice:
    """Chooses courses, one after the other."""

    def __init__(self) -> None:
        """Prepare the courses that are tried."""
        count = round(WIDEST / APART)
        self._courses = APART * np.arange(-count, count + 1)
        self._times = STEP * np.arange(1, round(HORIZON / STEP) + 1)
        self._chosen: float | None = None

    def reset(self) -> None:
        """Forget what was chosen."""
        self._chosen = None

    def choose(self, own: Own, others: Others) -> float | None:
        """Return the course to take from now on [rad], from that of the route; None for back to the route and along it."""
        home = sight(own.starboard)
        commands = np.concatenate([[home], self._courses])
        before = home if self._chosen is None else self._chosen
        off = commands - home
        cost = ON_DEVIATION * np.where(off < 0.0, -ON_PORT * off, off)
        cost += ON_CHANGE * np.abs(commands - before)
        if len(others.places):
            cost += self._risk(own, others)
        best = int(np.argmin(cost))
        self._chosen = None if best == 0 else float(commands[best])
        return self._chosen

    def _ways(self, own: Own) -> Array:
        """Return courses over time, shape (1 + courses, times): the first goes back to the route and along it."""
        back = -np.arctan(own.starboard / LOOK_AHEAD * np.exp(-self._times / LOOK_AHEAD))
        wanted = np.concatenate(
            [back[None], np.broadcast_to(self._courses[:, None], (len(self._courses), len(back)))]
        )
        turn = wanted - own.course
        begun = np.clip(np.sign(turn) * own.turning / own.fastest, 0.0, 1.0)
        reach = own.fastest * np.maximum(0.0, self._times - LAG * (1.0 - begun))
        return own.course + np.clip(turn, -reach, reach)

    def _risk(self, own: Own, others: Others) -> Array:
        """Return the cost of coming near to others and of wrong sides, of each course."""
        ways = self._ways(own)
        along, across = np.cos(ways), np.sin(ways)
        x = others.places[:, 0, None] + others.velocities[:, 0, None] * self._times
        y = others.places[:, 1, None] + others.velocities[:, 1, None] * self._times
        dx = x[None] - STEP * np.cumsum(along, axis=1)[:, None]
        dy = y[None] - STEP * np.cumsum(across, axis=1)[:, None]
        squares = dx * dx + dy * dy
        when = np.argmin(squares, axis=2)

        def there(values: Array) -> Array:
            return np.take_along_axis(values, when[..., None], axis=2)[..., 0]

        distance, time = np.sqrt(there(squares)), self._times[when]
        sideways_x = others.velocities[:, 0] - np.take_along_axis(along, when, axis=1)
        sideways_y = others.velocities[:, 1] - np.take_along_axis(across, when, axis=1)
        turning = there(dx) * sideways_y - there(dy) * sideways_x
        near = ON_NEAR * np.maximum(0.0, 1.0 - distance / NEAR)
        near += ON_TOO_NEAR * np.maximum(0.0, 1.0 - distance / TOO_NEAR)
        near = np.where(others.give_way | (time < STAND_ON), near, 0.0)
        wrong = others.to_port & (turning > 0.0) & (when > 0)
        return (near + np.where(wrong, ON_WRONG_SIDE, 0.0)).sum(axis=1)
