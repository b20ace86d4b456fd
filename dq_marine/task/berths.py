"""Berths at a quay, between piers: how a hull lies before the walls, and what comes of its coming alongside.

All is seen from above, along the axes of the berth: x ahead of a moored vessel, y away from the quay. The quay's
fenders are at y = 0, however far along it; piers stand out from it on both sides, alike. Of two convex outlines that
are apart, the least distance is at a corner of one of them, so that the hull's corners and the piers' are all that is
looked at. Fenders do not push back: a hull that touches them slowly may press them in for so far as they give.

How fast ships may come to fenders is from W. Brolsma's curves (PIANC 2002, Guidelines for the Design of Fender Systems,
sec. 4.2.3): up to 0.2 m/s and less for large ones, about with the inverse of the length, but hardly below 0.1 m/s.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.distances import box_distance, plane_distance
from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.level import Level, level_bow, level_cross, level_dot, level_length, seen_at
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, norm
from dq_marine.integrator.body import Motion
from dq_marine.task.world.pillars import Hull

FASTEST, SLOWEST, AT_LENGTH = 0.2, 0.1, 100.0
"""Contact speeds of ships of up to this length [m/s, m], and the least of long ones."""


class Harbour(NamedTuple):
    """Where the walls are, and the hull that is to lie there [m].

    Attributes:
        hull: half its length and beam.
        clearance: between the fenders and the side of the moored vessel.
        pier: how far piers stand out from the quay; 0 for none.
        basin: half of the room between the piers.
        thickness: of the piers, along the quay.
    """

    hull: Hull
    clearance: float
    pier: float
    basin: float
    thickness: float


class Berth(NamedTuple):
    """Where the bow of the moored vessel points, as a level unit vector; whether the quay is to starboard, or to port.

    The last is 1 or -1. The origin of the moored vessel is at that of NED.
    """

    north: float
    east: float
    side: float


class Alongside(NamedTuple):
    """A vessel before its berth.

    Attributes:
        place: of its origin, ahead of the berth's and away from the fenders [m].
        bow: where it points along the same axes, a unit vector.
        off_parallel: angle of the bow and the quay [rad], more than 0 where it points to starboard of it.
        speed: over ground [m/s].
    """

    place: Level
    bow: Level
    off_parallel: float
    speed: float


class Box(NamedTuple):
    """Where a vessel is alongside: distance along, clearance [m]; angle to the quay [rad]; speed over ground [m/s]."""

    along: float
    clearance: float
    angle: float
    speed: float


class Limits(NamedTuple):
    """Of contact: with which speed a hull may close with a wall that it touches [m/s], how far fenders give [m]."""

    speed: float
    give: float


class Berthing(NamedTuple):
    """What came of coming alongside.

    Attributes:
        distance: from the berth [m].
        along: the part of it along the quay [m].
        angle: of the bow and the quay [rad].
        clearance: of the hull from the nearest wall [m]; less than 0 where it presses the fenders.
        alongside: for how long it has been in its box [s].
        struck: 1 where it has hit a wall, else 0.
        impact_speed: with which the hull has closed with a wall that it touches [m/s], or 0.
    """

    distance: float
    along: float
    angle: float
    clearance: float
    alongside: float
    struck: float
    impact_speed: float


def contact_speed_of(length: float, cruising: float) -> float:
    """Return how fast a vessel may touch fenders [m/s]: see above; of small ones, a tenth of the cruising speed."""
    return min(max(SLOWEST, FASTEST * min(1.0, AT_LENGTH / length)), 0.1 * cruising)


def drawn_berth(uniforms: tuple[float, ...], first: int) -> Berth:
    """Return a berth at any heading, with the quay on either side, by two uniform random numbers from `first` on."""
    course = math.tau * uniforms[first]
    return Berth(math.cos(course), math.sin(course), 1.0 if uniforms[first + 1] < 0.5 else -1.0)


def abeam(harbour: Harbour) -> float:
    """Return how far the origin of the moored vessel is from the fenders [m]."""
    return harbour.hull.half_beam + harbour.clearance


def from_berth(harbour: Harbour, berth: Berth, along: float, off: float) -> Level:
    """Return a place along a berth's axes [m] in NED."""
    aside = berth.side * (abeam(harbour) - off)
    return (along * berth.north - aside * berth.east, along * berth.east + aside * berth.north)


def before_berth(harbour: Harbour, berth: Berth, motion: Motion) -> Alongside:
    """Return how a vessel lies before its berth."""
    course, place = (berth.north, berth.east), (motion.position_ned[0], motion.position_ned[1])
    bow, velocity = level_bow(motion.attitude), rotate(motion.attitude, motion.velocity.linear)
    return Alongside(
        (level_dot(course, place), abeam(harbour) - berth.side * level_cross(course, place)),
        (level_dot(course, bow), -(berth.side * level_cross(course, bow))),
        seen_at(course, bow),
        norm((velocity[0], velocity[1], 0.0)),
    )


def wall_distance(harbour: Harbour, along: float, off: float) -> float:
    """Return how far a place is from the nearest wall [m]; less than 0 within it."""
    quay = plane_distance((along, off, 0.0), (0.0, 1.0, 0.0), 0.0)
    half, deep = (0.5 * harbour.thickness, 0.5 * harbour.pier), harbour.thickness + harbour.pier
    pier = box_distance(
        (abs(along), off, 0.0), (harbour.basin + half[0], half[1], 0.0), (half[0], half[1], deep)
    )
    return min(quay, pier)


def hull_distance(hull: Hull, own: Alongside, along: float, off: float) -> float:
    """Return how far a place is from a hull, a rectangle [m]; less than 0 within it."""
    offset, deep = (along - own.place[0], off - own.place[1]), hull.half_length + hull.half_beam
    seen = (level_dot(own.bow, offset), level_cross(own.bow, offset), 0.0)
    return box_distance(seen, (0.0, 0.0, 0.0), (hull.half_length, hull.half_beam, deep))


def clearance(harbour: Harbour, own: Alongside) -> float:
    """Return how far a hull is from the nearest wall [m]; less than 0 where a corner of it is in the wall."""
    hull, inner, outer = harbour.hull, harbour.basin, harbour.basin + harbour.thickness
    bow = min(_corner(harbour, own, 1.0, 1.0), _corner(harbour, own, 1.0, -1.0))
    stern = min(_corner(harbour, own, -1.0, 1.0), _corner(harbour, own, -1.0, -1.0))
    ahead = min(hull_distance(hull, own, inner, harbour.pier), hull_distance(hull, own, outer, harbour.pier))
    astern = min(
        hull_distance(hull, own, -inner, harbour.pier), hull_distance(hull, own, -outer, harbour.pier)
    )
    return min(min(bow, stern), min(ahead, astern))


def _corner(harbour: Harbour, own: Alongside, ahead: float, aside: float) -> float:
    """Return how far a corner of the hull is from the nearest wall [m]."""
    x, y = ahead * harbour.hull.half_length, aside * harbour.hull.half_beam
    bow = own.bow
    return wall_distance(
        harbour, own.place[0] + x * bow[0] - y * bow[1], own.place[1] + x * bow[1] + y * bow[0]
    )


def room_left(harbour: Harbour, berth: Berth, motion: Motion) -> float:
    """Return how far a vessel is from the nearest wall [m]; less than 0 where it presses the fenders."""
    return clearance(harbour, before_berth(harbour, berth, motion))


def first_berthing(harbour: Harbour, berth: Berth, motion: Motion) -> Berthing:
    """Return that nothing has come of it yet."""
    return berthing_seen(harbour, before_berth(harbour, berth, motion), 0.0, 0.0, 0.0)


def berthing_kept(
    harbour: Harbour,
    box: Box,
    limits: Limits,
    berth: Berth,
    before: Berthing,
    motion: Motion,
    period: float,
) -> Berthing:
    """Return what came of a control period.

    Args:
        harbour: where the walls are.
        box: within which a vessel is alongside.
        limits: of contact with walls.
        berth: where the vessel is to lie.
        before: what had come of the periods before.
        motion: of the vessel at the end of this one.
        period: how long it was [s].
    """
    own = before_berth(harbour, berth, motion)
    room = clearance(harbour, own)
    impact = select(room < 0.0, max((before.clearance - room) / period, 0.0), 0.0)
    struck = (impact > limits.speed) | (room < -limits.give)
    inside = (abs(own.place[0]) < box.along) & (room < box.clearance) & (own.speed < box.speed)
    there = inside & (abs(own.off_parallel) < box.angle)
    held = select(there, before.alongside + period, 0.0)
    return berthing_seen(harbour, own, held, select(struck, 1.0, before.struck), impact)


def merits(harbour: Harbour, box: Box, far: float, came: Berthing) -> Vector3:
    """Return how near a vessel is to its berth, from afar and close by, and how parallel to the quay: each at most 1.

    Rewards are for their changes, as those of `dq_marine.task.docks.merits`: waiting off the quay earns nothing.

    Args:
        harbour: half the length of its hull is the scale close by.
        box: its angle is that of being parallel.
        far: distance at which the nearness from afar is 1/e [m].
        came: what has come of coming alongside.
    """
    turned, length = came.angle / box.angle, harbour.hull.half_length
    return (
        exponential(-came.distance / far),
        exponential(-came.distance / length),
        exponential(-turned * turned),
    )


def berthing_seen(
    harbour: Harbour, own: Alongside, alongside: float, struck: float, impact_speed: float
) -> Berthing:
    """Return what came of coming alongside, with where the vessel is."""
    along, aside = own.place[0], own.place[1] - abeam(harbour)
    distance, room = level_length((along, aside)), clearance(harbour, own)
    return Berthing(distance, abs(along), abs(own.off_parallel), room, alongside, struck, impact_speed)
