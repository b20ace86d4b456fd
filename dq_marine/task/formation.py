"""Formations: a leader along a curve, and others at fixed places in the axes of its course.

The leader is at p with the velocity v, its course turns at w, and a place (x, y) is x ahead and y to starboard of it,
level with it. Who keeps that place is at p + x e + y n with the course's unit vectors e and n, and goes at

    v + w (x n - y e),                                                                                  (1)

faster outside of a bend and slower inside.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.level import Level, level_bow, seen_at
from dq_marine.algebra.vector3 import add, add_scaled, norm, scale, subtract
from dq_marine.integrator.body import Motion
from dq_marine.task.acoustics import Sender
from dq_marine.task.common import make_pick
from dq_marine.task.harmonics import CurvePoint, course_rate, level_course

FOLLOWERS: tuple[Level, Level, Level] = ((-1.0, -1.0), (-1.0, 1.0), (-2.0, 0.0))
"""Places of a diamond behind its leader [spacings]: to port, to starboard, and last."""

pick = make_pick(len(FOLLOWERS))


class Places(NamedTuple):
    """Places in the axes of the leader's course, ahead and to starboard [m]: one's own, and of the two others."""

    own: Level
    second: Level
    third: Level


def drawn_places(spacing: float, uniform: float) -> Places:
    """Return who is where in a diamond with a spacing [m], by a uniform random number."""
    number = 3.0 * uniform - 0.5
    second, third = pick(number, (1.0, 2.0, 0.0)), pick(number, (2.0, 0.0, 1.0))
    own, one, other = pick(number, FOLLOWERS), pick(second, FOLLOWERS), pick(third, FOLLOWERS)
    return Places(
        (spacing * own[0], spacing * own[1]),
        (spacing * one[0], spacing * one[1]),
        (spacing * other[0], spacing * other[1]),
    )


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


class Formation(NamedTuple):
    """Where all are: the leader and the two others, and who would be in one's own place."""

    others: tuple[Sender, Sender, Sender]
    own: Sender


def formation(leader: CurvePoint, speed: float, places: Places) -> Formation:
    """Return where all are, with the leader at a point of its curve, at a speed [m/s]."""
    rate = speed / norm(leader.slope_ned)
    others = (
        member(leader, rate, (0.0, 0.0)),
        member(leader, rate, places.second),
        member(leader, rate, places.third),
    )
    return Formation(others, member(leader, rate, places.own))


class Keeping(NamedTuple):
    """How a vehicle keeps its place: distance from it [m], bow off the course there [rad], distance to the nearest [m]."""

    off: float
    turned: float
    nearest: float


def keeping(here: Formation, motion: Motion) -> Keeping:
    """Return how a vehicle keeps its place in a formation."""
    place, (north, east, _) = motion.position_ned, here.own.velocity_ned
    first, second, third = here.others
    return Keeping(
        norm(subtract(here.own.position_ned, place)),
        abs(seen_at(level_bow(motion.attitude), (north, east))),
        min(
            norm(subtract(first.position_ned, place)),
            min(norm(subtract(second.position_ned, place)), norm(subtract(third.position_ned, place))),
        ),
    )


def places_from_own(places: Places) -> tuple[Level, Level, Level]:
    """Return the places of the leader and of the two others, seen from one's own."""
    (x, y), (x2, y2), (x3, y3) = places
    return ((-x, -y), (x2 - x, y2 - y), (x3 - x, y3 - y))


def make_advance(point: Callable[[Any, float], CurvePoint]) -> Callable[[Any, float, float], float]:
    """Return (controls, parameter, way [m]) -> the parameter after a short way along a curve, by the midpoint rule."""

    def advance(controls: Any, parameter: float, way: float) -> float:
        half = parameter + 0.5 * way / norm(point(controls, parameter).slope_ned)
        return parameter + way / norm(point(controls, half).slope_ned)

    return advance
