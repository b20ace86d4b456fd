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

LASTING = 15.0
"""Courses off the route cost by the time until the way back is free, over this [own lengths gone]."""

CLEAR, BACK = 3.0, 10.0
"""Distance at which the way back is free, and how long it takes [own lengths, own lengths gone]."""

STAND_ON = 15.0
"""Rule 17: how long before it is nearest one acts for a vessel that has to give way, and does not [lengths gone]."""

ON_TOO_NEAR, ON_NEAR, ON_WRONG_SIDE, ON_DEVIATION, ON_PORT, ON_CHANGE = 1000.0, 30.0, 60.0, 10.0, 1.5, 4.0
"""Costs: of the share of both distances that is lacking; of a side; of courses off the route [1/rad], times this to
port; and of another course than before [1/rad]."""

ON_SLOWNESS, ON_SPEED_CHANGE = 16.0, 4.0
"""Costs of the speed that is lacking, and of another one than before, over that of the route."""


class Others(NamedTuple):
    """Other vessels: places [lengths] and velocities over one's own speed, along the route and to starboard, and rules.

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
        off = commands - home
        of_courses = ON_DEVIATION * np.where(off < 0.0, -ON_PORT * off, off)
        costs = self._of_changes(commands, np.array(speeds))
        for row, speed in zip(costs, speeds, strict=True):
            risk, lasting = self._risk(own, others, speed)
            row += risk + (0.2 + lasting) * (of_courses + ON_SLOWNESS * (1.0 - speed))
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
        """Return the cost of coming near to others and of wrong sides, and how long courses are held, over `LASTING`.

        Both are of each course at a speed, shape (1 + courses,). A course is held until the way back is free.
        """
        count = 1 + len(self._courses)
        if not len(others.places):
            return np.zeros(count), np.zeros(count)
        ways, speeds = self._ways(own, speed)
        velocity = np.stack([speeds * np.cos(ways), speeds * np.sin(ways)], axis=-1)[:, None]
        gone = STEP * np.cumsum(velocity, axis=2)
        theirs = others.velocities[None, :, None]
        offset = others.places[None, :, None] + theirs * self._times[:, None] - gone
        free = self._free(own.starboard + gone[..., 1], offset, theirs, others.to_port)
        until = np.where(free.any(axis=1), np.argmax(free, axis=1), len(self._times) - 1)
        lasting = self._times[until] / LASTING
        if speed == 1.0:
            until[0] = len(self._times) - 1
        squares = np.sum(offset * offset, axis=-1)
        squares[np.broadcast_to((np.arange(len(self._times)) > until[:, None])[:, None], squares.shape)] = (
            np.inf
        )
        when = np.argmin(squares, axis=2)
        at = when[..., None]
        distance, time = np.sqrt(np.take_along_axis(squares, at, axis=2)[..., 0]), self._times[when]
        sight_turns = np.take_along_axis(_cross(offset, theirs - velocity), at, axis=2)[..., 0]
        near = ON_NEAR * np.maximum(0.0, 1.0 - distance / NEAR)
        near += ON_TOO_NEAR * np.maximum(0.0, 1.0 - distance / TOO_NEAR)
        near = np.where(others.give_way | (time < STAND_ON), near, 0.0)
        wrong = others.to_port & (sight_turns > 0.0) & (when > 0) & (when < until[:, None])
        risk: Array = (near + np.where(wrong, ON_WRONG_SIDE, 0.0)).sum(axis=1)
        return risk, np.asarray(lasting)

    def _free(
        self, starboard: Array, offset: Array, theirs: Array, to_port: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        """Return where the way back to the route, and then along it, is free of all others, shape (courses, times)."""
        back = -np.arctan(starboard / LOOK_AHEAD)
        home = theirs - np.stack([np.cos(back), np.sin(back)], axis=-1)
        along = theirs - np.array([1.0, 0.0])
        # Where the line of sight has led back to the route, some time later.
        later = offset + BACK * along + np.stack([np.zeros_like(starboard), starboard], axis=-1)
        return np.asarray(
            (_clear(offset, home, to_port) & _clear(later, along, to_port)).all(axis=1), dtype=np.bool_
        )


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _clear(offset: Array, velocity: Array, to_port: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return whether vessels that keep their velocities pass well clear, and on the right side, or are past."""
    closing = -np.sum(offset * velocity, axis=-1)
    squared = np.sum(velocity * velocity, axis=-1)
    turning = _cross(offset, velocity)
    passing = (np.abs(turning) > CLEAR * np.sqrt(squared)) & ~(to_port[:, None] & (turning > 0.0))
    past = (closing <= 0.0) & (np.sum(offset * offset, axis=-1) > CLEAR**2)
    return np.asarray(past | ((closing > 0.0) & passing))
