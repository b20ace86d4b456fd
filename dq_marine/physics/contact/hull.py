"""The spheres by which a vehicle touches what is solid, from its overall size and the kind of its hull."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING

from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.contact import HullSpheres

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

ROUND = ("torpedo", "ellipsoid")
"""Hulls that are touched along their axis; others as boxes."""

MOST_ALONG = 9
"""Spheres one behind the other."""

EDGE = 0.1
"""Radius of a box's corners, over its least side."""


def hull_spheres(vehicle: Vehicle) -> HullSpheres:
    """Return the spheres of a vehicle: along the axis of a round hull, so that they overlap; else at corners of a box.

    Along a box that is longer than wide there are more of them between the corners, about a width apart.
    """
    size = vehicle.dimensions
    if size.shape in ROUND:
        radius = 0.5 * min(size.width, size.height)
        centers = _along_axis(size.length, radius)
    else:
        radius = EDGE * min(size.length, size.width, size.height)
        keel = 0.5 * size.height if size.draft is None else size.draft
        downs = (keel - size.height + radius, keel - radius)
        easts = (radius - 0.5 * size.width, 0.5 * size.width - radius)
        count = min(max(2, math.ceil(size.length / size.width)), MOST_ALONG)
        centers = list(product(_spread(0.5 * size.length - radius, count), easts, downs))
    return spheres_about(centers, radius)


def spheres_about(centers: Sequence[Vector3], radius: float) -> HullSpheres:
    """Return spheres of one radius [m] about places in the body frame [m]."""
    x, y, z = (Table(float(center[axis]) for center in centers) for axis in range(3))
    reach = radius + max(math.hypot(*center) for center in centers)
    return HullSpheres(x, y, z, Table(float(radius) for _ in centers), reach)


def _along_axis(length: float, radius: float) -> list[Vector3]:
    reach = 0.5 * length - radius
    if reach <= 0.0:
        return [(0.0, 0.0, 0.0)]
    count = min(max(2, math.ceil(reach / radius) + 1), MOST_ALONG)
    return [(x, 0.0, 0.0) for x in _spread(reach, count)]


def _spread(reach: float, count: int) -> list[float]:
    """Return so many numbers, two or more, from -reach to reach."""
    return [reach * (2.0 * number / (count - 1) - 1.0) for number in range(count)]
