"""What the worlds of tasks look like: pillars, other vessels, docks and lines to follow, as things to draw; beams."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.level import Level, from_above
from dq_marine.algebra.vector3 import Vector3
from dq_marine.task.acoustics import Sender
from dq_marine.task.berths import Berth, Harbour, from_berth
from dq_marine.task.docks import Dock, Funnel, heave_of
from dq_marine.task.harmonics import Curve, curve_point
from dq_marine.task.things import (
    Beam,
    Block,
    Cage,
    Column,
    Cone,
    Line,
    Relief,
    ShipHull,
    Thing,
    TorpedoHull,
    Tube,
)
from dq_marine.task.traffic import OtherVessel
from dq_marine.task.world.beams import Fan, directions_of
from dq_marine.task.world.pillars import Hull, Layout, Pillar

BEAM = 0.16
"""Of other vessels, over their length, which alone is known of them."""

QUAY_LENGTH, QUAY_WIDTH, QUAY_HEIGHT, QUAY_DEPTH = 14.0, 1.0, 0.06, 0.25
"""Of what is drawn of a quay, over the length of the vessel: along it, across, above the water and below."""

TURNS = 3.0
"""Of a curve of harmonics: a helix goes on."""

POINTS = 241
"""At which a curve is drawn."""

SAMPLES = 49
"""Of the ground, along each axis."""


def field_seen(pillars: Sequence[Pillar], layout: Layout, depth: float, hull: Hull) -> list[Thing]:
    """Return pillars or cages to draw, from the surface to twice the depth of a vehicle [m], or twice its length."""
    height = 2.0 * max(depth, 2.0 * hull.half_length)
    if layout.netted:  # its collar floats
        return [Thing(Cage(cage.radius, height), (cage.north, cage.east, 0.5 * height)) for cage in pillars]
    return [
        Thing(Column(pillar.radius, height), (pillar.north, pillar.east, max(depth, 0.25 * height)))
        for pillar in pillars
    ]


def vessels_seen(others: Sequence[OtherVessel], length: float) -> list[Thing]:
    """Return the vessels that are there, as long as one's own [m]."""
    return [
        Thing(
            ShipHull(length, BEAM * length),
            (other.place[0], other.place[1], 0.0),
            quaternion_from_euler(0.0, 0.0, math.atan2(other.velocity[1], other.velocity[0])),
        )
        for other in others
        if other.present > 0.5
    ]


def formation_seen(others: Sequence[Sender], length: float) -> list[Thing]:
    """Return the vehicles of a formation, as long as one's own [m], heading where they go."""
    return [
        Thing(
            TorpedoHull(length, BEAM * length),
            other.position_ned,
            quaternion_from_euler(0.0, 0.0, math.atan2(other.velocity_ned[1], other.velocity_ned[0])),
        )
        for other in others
    ]


def dock_seen(dock: Dock, funnel: Funnel) -> list[Thing]:
    """Return a dock's funnel where it is now."""
    mouth = funnel.throat + funnel.length * funnel.flare
    heading = math.atan2(dock.east, dock.north)
    place = (0.0, 0.0, heave_of(dock)[0])
    return [Thing(Cone(funnel.throat, mouth, funnel.length), place, quaternion_from_euler(0.0, 0.0, heading))]


def harbour_seen(harbour: Harbour, berth: Berth) -> list[Thing]:
    """Return a quay, as far as it is drawn, and the piers that stand out from it."""
    length, heading = 2.0 * harbour.hull.half_length, math.atan2(berth.east, berth.north)
    high, half_width = length * (QUAY_HEIGHT + QUAY_DEPTH), 0.5 * QUAY_WIDTH * length
    along = harbour.basin + 0.5 * harbour.thickness
    blocks = [((0.0, -half_width), (QUAY_LENGTH * length, 2.0 * half_width))]
    if harbour.pier > 0.0:
        size = (harbour.thickness, harbour.pier)
        blocks += [((side * along, 0.5 * harbour.pier), size) for side in (-1.0, 1.0)]
    return [
        Thing(
            Block(*size, high),
            (*from_berth(harbour, berth, *place), 0.5 * high - QUAY_HEIGHT * length),
            quaternion_from_euler(0.0, 0.0, heading),
        )
        for place, size in blocks
    ]


def harmonics_seen(curve: Curve, thickness: float) -> list[Thing]:
    """Return the first turns of a curve of harmonics to follow."""
    return curve_seen(lambda phase: curve_point(curve, phase).position_ned, TURNS * math.tau, thickness)


def line_seen(points: Sequence[Vector3], thickness: float) -> list[Thing]:
    """Return a line to follow through points, as thick as that [m]."""
    return [Thing(Line(tuple(points), 0.5 * thickness))]


def ground_seen(
    depth: Callable[[Any, float, float], float], ground: Any, track: Sequence[Level], margin: float
) -> list[Thing]:
    """Return the ground about a track, given by places on it, as far as a margin beyond them [m].

    Args:
        depth: (ground, north, east) -> depth there [m].
        ground: what that is about.
        track: places, seen from above [m].
        margin: how far around them the ground is drawn [m].
    """
    norths, easts = (_sampled([place[axis] for place in track], margin) for axis in (0, 1))
    depths = tuple(depth(ground, north, east) for north in norths for east in easts)
    return [Thing(Relief(norths, easts, depths))]


def pipe_seen(
    depth: Callable[[Any, float, float], float],
    ground: Any,
    route: Sequence[Vector3],
    radius: float,
    margin: float,
) -> list[Thing]:
    """Return a pipe that lies on the ground, and the ground about it.

    Args:
        depth: (ground, north, east) -> depth there [m].
        ground: what that is about.
        route: points above or below the pipe [m].
        radius: of the pipe [m].
        margin: how far around it the ground is drawn [m].
    """
    places = [from_above(point) for point in route]
    axis = tuple((north, east, depth(ground, north, east) - radius) for north, east in places)
    return [*ground_seen(depth, ground, places, margin), Thing(Tube(axis, radius))]


def beams_seen(fan: Fan, readings: Callable[..., Any], ranges: Any, errors: Any, reach: float) -> list[Beam]:
    """Return beams from the vehicle's origin, by what they tell the agent: the whole reach where no echo came back.

    Args:
        fan: where they point.
        readings: of `make_readings`.
        ranges: of the beams [m].
        errors: of their readings.
        reach: the largest range [m].
    """
    return [
        Beam(direction, reading * reach, reach)
        for direction, reading in zip(directions_of(fan), readings(ranges, errors, reach), strict=True)
    ]


def _sampled(along: Sequence[float], margin: float) -> tuple[float, ...]:
    least, most = min(along) - margin, max(along) + margin
    return tuple(least + (most - least) * number / (SAMPLES - 1) for number in range(SAMPLES))


def curve_seen(at: Callable[[float], Vector3], end: float, thickness: float) -> list[Thing]:
    """Return a curve to follow, given by its point [m] at any parameter from 0 to an end."""
    return line_seen(along_curve(at, end), thickness)


def along_curve(at: Callable[[float], Vector3], end: float) -> list[Vector3]:
    """Return `POINTS` points of a curve that is given by its point at any parameter from 0 to an end [m]."""
    return [at(end * number / (POINTS - 1)) for number in range(POINTS)]
