"""What the worlds of tasks look like: pillars, other vessels, docks and lines to follow, as things to draw."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.vector3 import Vector3
from dq_marine.task.acoustics import Sender
from dq_marine.task.docks import Dock, Funnel, heave_of
from dq_marine.task.harmonics import Curve, curve_point
from dq_marine.task.things import Column, Cone, Line, ShipHull, Thing, TorpedoHull
from dq_marine.task.traffic import OtherVessel
from dq_marine.task.world.pillars import Pillar

BEAM = 0.16
"""Of other vessels, over their length, which alone is known of them."""

TURNS = 3.0
"""Of a curve of harmonics: a helix goes on."""

POINTS = 241
"""At which a curve is drawn."""


def pillars_seen(pillars: Sequence[Pillar], depth: float, length: float) -> list[Thing]:
    """Return pillars to draw, from the surface to as far below the depth of a vehicle of a length [m]."""
    height = 2.0 * max(depth, length)
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


def harmonics_seen(curve: Curve, thickness: float) -> list[Thing]:
    """Return the first turns of a curve of harmonics to follow."""
    return curve_seen(lambda phase: curve_point(curve, phase).position_ned, TURNS * math.tau, thickness)


def line_seen(points: Sequence[Vector3], thickness: float) -> list[Thing]:
    """Return a line to follow through points, as thick as that [m]."""
    return [Thing(Line(tuple(points), 0.5 * thickness))]


def curve_seen(at: Callable[[float], Vector3], end: float, thickness: float) -> list[Thing]:
    """Return a curve to follow, given by its point [m] at any parameter from 0 to an end."""
    return line_seen([at(end * number / (POINTS - 1)) for number in range(POINTS)], thickness)
