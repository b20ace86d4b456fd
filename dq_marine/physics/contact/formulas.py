"""Signed distances to solids, of their numbers and a point: in a solid's own axes, and where it stands."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

from dq_marine.algebra.distances import (
    box_distance,
    capsule_distance,
    pillar_distance,
    plane_distance,
    sphere_distance,
)
from dq_marine.algebra.vector3 import Vector3, subtract
from dq_marine.integrator.contact import Distance

ORIGIN: Vector3 = (0.0, 0.0, 0.0)


class Place(NamedTuple):
    """Where a solid stands: its origin in NED [m]; cosine and sine of its heading; its own numbers."""

    position_ned: Vector3
    cosine: float
    sine: float
    own: Any


@functools.cache
def make_placed(distance: Distance) -> Distance:
    """Return (place, point in NED) -> distance to the solid where it stands."""

    def placed(place: Place, point: Vector3) -> float:
        north, east, down = subtract(point, place.position_ned)
        ahead = place.cosine * north + place.sine * east
        return distance(place.own, (ahead, place.cosine * east - place.sine * north, down))

    return placed


def distance_of_plane(normal: Vector3, point: Vector3) -> float:
    """Return the distance to what is behind a plane through the origin."""
    return plane_distance(point, normal, 0.0)


def distance_of_ball(radius: tuple[float], point: Vector3) -> float:
    """Return the distance to a ball about the origin."""
    return sphere_distance(point, ORIGIN, radius[0])


def distance_of_box(half_size: Vector3, point: Vector3) -> float:
    """Return the distance to a box about the origin."""
    return box_distance(point, ORIGIN, half_size)


def distance_of_pillar(radius: tuple[float], point: Vector3) -> float:
    """Return the distance to an endless vertical cylinder through the origin."""
    return pillar_distance(point, 0.0, 0.0, radius[0])


def distance_of_rod(end_and_radius: tuple[Vector3, float], point: Vector3) -> float:
    """Return the distance to a rod with round ends, from the origin to an end."""
    return capsule_distance(point, ORIGIN, end_and_radius[0], end_and_radius[1])
