"""Formations: a leader along a winding course, and others at fixed places in the axes of its course.

The leader is at p with the velocity v, its course turns at w, and a place (x, y) is x ahead and y to starboard of it,
level with it. Who keeps that place is at p + x e + y n with the course's unit vectors e and n, and goes at

    v + w (x n - y e),                                                                                  (1)

faster outside of a bend and slower inside.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_bow, level_turned, seen_at
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, dot, norm, scale, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Sender
from dq_marine.task.common import make_pick
from dq_marine.task.harmonics import CurvePoint, course_rate, level_course
from dq_marine.task.splines import make_onward, make_spline, make_winding, winding_draws

FOLLOWERS: tuple[Level, Level, Level] = ((-1.0, -1.0), (-1.0, 1.0), (-2.0, 0.0))
"""Places of a diamond behind its leader [spacings]: to port, to starboard, and last."""

pick = make_pick(len(FOLLOWERS))


class Places(NamedTuple):
    """Places in the axes of the leader's course, ahead and to starboard [m]: one's own, and of the two others."""

    own: Level
    second: Level
    third: Level


class Winding(NamedTuple):
    """What a leader's course is drawn by: legs [m], and by how much they turn and climb at most [rad]."""

    leg: float
    turn: float
    climb: float


class March(NamedTuple):
    """Control points of the leader's course [m], its parameter, the places of the others; length of the slope [m]."""

    controls: Any
    parameter: float
    places: Places
    stretch: float


class Formation(NamedTuple):
    """Where all are: the leader and the two others, and who would be in one's own place."""

    others: tuple[Sender, Sender, Sender]
    own: Sender


class Keeping(NamedTuple):
    """How a vehicle keeps its place: distance from it [m], bow off the course there [rad], distance of others [m]."""

    off: float
    turned: float
    nearest: float


class Marches(NamedTuple):
    """A formation along a course of a number of spans, as pure functions.

    Attributes:
        draws: uniform random numbers that a march takes.
        first: (spacing [m], uniforms, index) -> course at its beginning [rad], and one's own place [m].
        drawn: (spacing [m], where the leader begins [m], its course, uniforms, index) -> march at its beginning.
        onward: (march, way of the leader [m], which is short) -> march after it, by the midpoint rule.
        formation: (march, speed of the leader [m/s]) -> where all are.
    """

    draws: int
    first: Callable[[float, tuple[float, ...], int], tuple[float, Level]]
    drawn: Callable[[float, Vector3, Winding, tuple[float, ...], int], March]
    onward: Callable[[March, float], March]
    formation: Callable[[March, float], Formation]


def make_marches(spans: int) -> Marches:
    """Return the functions of a formation whose leader goes along so many spans, about a leg each."""
    point, wind = make_spline(spans).point, make_winding(spans)
    further = make_onward(point)

    def first(spacing: float, uniforms: tuple[float, ...], index: int) -> tuple[float, Level]:
        return math.tau * uniforms[index + 1], drawn_places(spacing, uniforms[index]).own

    def drawn(
        spacing: float, begin: Vector3, winding: Winding, uniforms: tuple[float, ...], index: int
    ) -> March:
        controls = wind(begin, winding.leg, winding.turn, winding.climb, uniforms, index + 1)
        places = drawn_places(spacing, uniforms[index])
        return March(controls, 0.0, places, norm(point(controls, 0.0).slope_ned))

    def onward(march: March, way: float) -> March:
        controls, parameter, places, stretch = march
        there = further(controls, parameter, stretch, way)
        # The slope is computed there for the formation, too: kept, it is not computed again a control period later.
        return March(controls, there, places, norm(point(controls, there).slope_ned))

    def formation(march: March, speed: float) -> Formation:
        leader, places = point(march.controls, march.parameter), march.places
        rate = speed / march.stretch
        return Formation(
            (
                member(leader, rate, (0.0, 0.0)),
                member(leader, rate, places.second),
                member(leader, rate, places.third),
            ),
            member(leader, rate, places.own),
        )

    return Marches(1 + winding_draws(spans), first, drawn, onward, formation)


def drawn_places(spacing: float, uniform: float) -> Places:
    """Return who is where in a diamond with a spacing [m], by a uniform random number."""
    number = len(FOLLOWERS) * uniform - 0.5
    own, second, third = (
        pick(number, FOLLOWERS),
        pick(number, (FOLLOWERS[1], FOLLOWERS[2], FOLLOWERS[0])),
        pick(number, (FOLLOWERS[2], FOLLOWERS[0], FOLLOWERS[1])),
    )
    return Places(
        (spacing * own[0], spacing * own[1]),
        (spacing * second[0], spacing * second[1]),
        (spacing * third[0], spacing * third[1]),
    )


def places_from_own(places: Places) -> tuple[Level, Level, Level]:
    """Return the places of the leader and of the two others, seen from one's own."""
    (x, y), (x2, y2), (x3, y3) = places
    return ((-x, -y), (x2 - x, y2 - y), (x3 - x, y3 - y))


def about_place(place: Level, spread: float, course: float, uniforms: tuple[float, ...], index: int) -> Level:
    """Return a point in a square about a place, drawn by two uniform numbers, in north and east of the leader [m].

    Args:
        place: ahead and to starboard of the leader [m].
        spread: half the side of the square [m].
        course: of the leader [rad].
        uniforms: random numbers in [0, 1).
        index: of the first that is used.
    """
    ahead = place[0] + spread * (2.0 * uniforms[index] - 1.0)
    starboard = place[1] + spread * (2.0 * uniforms[index + 1] - 1.0)
    return level_turned((ahead, starboard), course)


def member(leader: CurvePoint, rate: float, place: Level) -> Sender:
    """Return who keeps a place [m], by (1).

    Args:
        leader: where it is on its curve, which must not be vertical there.
        rate: at which the curve's parameter grows [1/s].
        place: ahead and to starboard of the leader [m].
    """
    ahead, starboard = level_course(leader.slope_ned)
    turning = course_rate(leader, rate)
    position = add(leader.position_ned, add_scaled(scale(place[0], ahead), place[1], starboard))
    swing = add_scaled(scale(turning * place[0], starboard), -(turning * place[1]), ahead)
    return Sender(position, add_scaled(swing, rate, leader.slope_ned))


def keeping(here: Formation, motion: Motion) -> Keeping:
    """Return how a vehicle keeps its place in a formation."""
    place, (north, east, _) = motion.position_ned, here.own.velocity_ned
    first, second, third = here.others
    nearest = min(_squared(first, place), min(_squared(second, place), _squared(third, place)))
    return Keeping(
        norm(subtract(here.own.position_ned, place)),
        abs(seen_at(level_bow(motion.attitude), (north, east))),
        math.sqrt(nearest),
    )


def _squared(sender: Sender, place: Vector3) -> float:
    """Return the square of the distance of a sender from a place [m^2]."""
    off = subtract(sender.position_ned, place)
    return dot(off, off)
