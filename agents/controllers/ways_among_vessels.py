"""How ways among other vessels compare: how near they come, on which side they pass, and how long they are held.

Plain loops, compiled: a controller compares some seventy ways, of ninety steps each, whenever it chooses. All is in
units of one's own length and of the time in which that is gone at the speed of the route.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.level import Level, level_cross, level_dot, level_length
from dq_marine.backend.compilation import compile_function

Array = NDArray[np.float64]

STEP, STEPS = 0.5, 90
"""In what steps ways are compared [own lengths gone], and how many: 45 lengths."""

LAG = 1.0
"""Way before a vessel that goes straight begins to turn [own lengths]."""

LOOK_AHEAD = 5.0
"""Of the line of sight, back to the route [own lengths]."""

BACK = 10.0
"""How long the way back to the route takes [own lengths gone]."""

STAND_ON = 15.0
"""Rule 17: how long before it is nearest one acts for a vessel that has to give way, and does not [lengths gone]."""

ON_TOO_NEAR, ON_NEAR, ON_WRONG_SIDE = 1000.0, 30.0, 60.0
"""Costs of the share of both distances that is lacking, and of a wrong side."""

ALONG, STARBOARD, ALONG_RATE, STARBOARD_RATE = 0, 1, 2, 3
"""Columns of a way: where one is then, and the velocity."""


class Distances(NamedTuple):
    """Distances to others [own lengths]: avoided at any cost, avoided where possible; at which a way back is free."""

    too_near: float
    near: float
    free: float


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


@functools.cache
def compiled_comparison() -> Callable[[Own, float, Array, Others, Distances, Array, Array], None]:
    """Return `compare_ways`, compiled when it is first called, or loaded from where that was kept."""
    compiled: Callable[..., Any] = compile_function(compare_ways, "ways among vessels")
    return compiled


def compare_ways(
    own: Own,
    speed: float,
    courses: Array,
    others: Others,
    distances: Distances,
    risk: Array,
    lasting: Array,
) -> None:
    """Fill in what it costs to come near to others and to pass on wrong sides, and how long a course is held [lengths].

    Args:
        own: vessel.
        speed: that is tried, over that of the route.
        courses: that are tried, from that of the route to starboard [rad], shape (n,).
        others: that are met.
        distances: that are kept to them.
        risk: of the way back to the route and along it, and of each course, shape (1 + n,).
        lasting: until the way back is free, likewise.
    """
    way = np.empty((STEPS, 4))
    for which in range(len(courses) + 1):
        homeward = which == 0
        _go(own, speed, homeward, 0.0 if homeward else courses[which - 1], way)
        until = _first_free(own.starboard, way, others, distances.free)
        lasting[which] = STEP * (until + 1)
        if homeward and speed == 1.0:
            until = STEPS - 1
        risk[which] = _risk(way, until, others, distances)


def sight(starboard: float) -> float:
    """Return the course back to the route from a cross-track error [lengths]: the line of sight."""
    return -math.atan(starboard / LOOK_AHEAD)


def _go(own: Own, speed: float, homeward: bool, wanted: float, way: Array) -> None:
    """Fill in the way that leads to a course by an arc, or back to the route and along it."""
    gone, along, starboard = 0.0, 0.0, 0.0
    for i in range(STEPS):
        change = own.braking * STEP * (i + 1)
        pace = own.speed + max(-change, min(change, speed - own.speed))
        gone += STEP * pace
        course = sight(own.starboard * math.exp(-gone / LOOK_AHEAD)) if homeward else wanted
        turn = course - own.course
        begun = min(1.0, abs(own.turning) / own.fastest) if turn * own.turning > 0.0 else 0.0
        reach = own.fastest * max(0.0, gone - LAG * (1.0 - begun))
        heading = own.course + max(-reach, min(reach, turn))
        velocity = (pace * math.cos(heading), pace * math.sin(heading))
        along, starboard = along + STEP * velocity[0], starboard + STEP * velocity[1]
        way[i, ALONG], way[i, STARBOARD] = along, starboard
        way[i, ALONG_RATE], way[i, STARBOARD_RATE] = velocity


def _offset(way: Array, others: Others, i: int, k: int) -> Level:
    """Return where another vessel is then, from where one's own is."""
    time = STEP * (i + 1)
    return (
        others.places[k, 0] + others.velocities[k, 0] * time - way[i, ALONG],
        others.places[k, 1] + others.velocities[k, 1] * time - way[i, STARBOARD],
    )


def _first_free(starboard: float, way: Array, others: Others, free: float) -> int:
    """Return the first step at which the way back to the route, and then along it, is free of all others, or the last.

    `starboard` is the cross-track error at the beginning of the way.
    """
    for i in range(STEPS):
        if _free(starboard + way[i, STARBOARD], way, others, i, free):
            return i
    return STEPS - 1


def _free(starboard: float, way: Array, others: Others, i: int, free: float) -> bool:
    back = sight(starboard)
    for k in range(len(others.places)):
        offset, theirs = _offset(way, others, i, k), (others.velocities[k, 0], others.velocities[k, 1])
        home, along = (theirs[0] - math.cos(back), theirs[1] - math.sin(back)), (theirs[0] - 1.0, theirs[1])
        # Where the line of sight has led back to the route, some time later.
        later = (offset[0] + BACK * along[0], offset[1] + BACK * along[1] + starboard)
        to_port = others.to_port[k]
        if not (_clear(offset, home, to_port, free) and _clear(later, along, to_port, free)):
            return False
    return True


def _clear(offset: Level, velocity: Level, to_port: bool, free: float) -> bool:
    """Return whether a vessel that keeps its velocity passes well clear, and on the right side, or is past."""
    if level_dot(offset, velocity) >= 0.0:
        return level_dot(offset, offset) > free * free
    turning = level_cross(offset, velocity)
    return abs(turning) > free * level_length(velocity) and not (to_port and turning > 0.0)


def _risk(way: Array, until: int, others: Others, distances: Distances) -> float:
    """Return what it costs to come near to others, and to pass them on wrong sides, until a step."""
    risk = 0.0
    for k in range(len(others.places)):
        nearest, when = _nearest(way, until, others, k)
        if others.give_way[k] or STEP * (when + 1) < STAND_ON:
            near = ON_NEAR * max(0.0, 1.0 - nearest / distances.near)
            risk += near + ON_TOO_NEAR * max(0.0, 1.0 - nearest / distances.too_near)
        relative = (
            others.velocities[k, 0] - way[when, ALONG_RATE],
            others.velocities[k, 1] - way[when, STARBOARD_RATE],
        )
        sight_turns = level_cross(_offset(way, others, when, k), relative)
        if others.to_port[k] and sight_turns > 0.0 and 0 < when < until:
            risk += ON_WRONG_SIDE
    return risk


def _nearest(way: Array, until: int, others: Others, k: int) -> tuple[float, int]:
    """Return the least distance to another vessel, and at which step that is."""
    least, when = math.inf, 0
    for i in range(until + 1):
        offset = _offset(way, others, i, k)
        squared = level_dot(offset, offset)
        if squared < least:
            least, when = squared, i
    return math.sqrt(least), when
