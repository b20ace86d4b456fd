"""Signed distances [m] from a point to the surface of a shape: negative inside it.

Each is continuous, changes by no more than the point moves, and has a gradient of length 1 wherever it has one. The
closed forms are those of Hart 1996, "Sphere tracing", The Visual Computer 12, 527, appendix A.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from dq_marine.algebra.level import level_length
from dq_marine.algebra.selection import smallest_normal
from dq_marine.algebra.vector3 import Vector3, add_scaled, dot, norm, subtract


def sphere_distance(point: Vector3, center: Vector3, radius: float) -> float:
    """Return the distance to a sphere."""
    return norm(subtract(point, center)) - radius


def plane_distance(point: Vector3, normal: Vector3, offset: float) -> float:
    """Return the distance to the plane n . p = offset, whose unit normal n points out of what is solid."""
    return dot(normal, point) - offset


def pillar_distance(point: Vector3, north: float, east: float, radius: float) -> float:
    """Return the distance to a vertical cylinder without ends."""
    return level_length((point[0] - north, point[1] - east)) - radius


def line_distance(point: Vector3, on_axis: Vector3, axis: Vector3, radius: float) -> float:
    """Return the distance to a straight pipe without ends, whose axis is a unit vector through a point."""
    off = subtract(point, on_axis)
    return norm(add_scaled(off, -dot(off, axis), axis)) - radius


def box_distance(point: Vector3, center: Vector3, half_size: Vector3) -> float:
    """Return the distance to a box along the axes."""
    x = abs(point[0] - center[0]) - half_size[0]
    y = abs(point[1] - center[1]) - half_size[1]
    z = abs(point[2] - center[2]) - half_size[2]
    inside = min(max(x, max(y, z)), 0.0)
    return norm((max(x, 0.0), max(y, 0.0), max(z, 0.0))) + inside


def capsule_distance(point: Vector3, begin: Vector3, end: Vector3, radius: float) -> float:
    """Return the distance to all that is within a radius of a line from begin to end, which may be one point."""
    along, off = subtract(end, begin), subtract(point, begin)
    squared = max(dot(along, along), smallest_normal(off[0]))
    share = max(0.0, min(1.0, dot(off, along) / squared))
    return norm(add_scaled(off, -share, along)) - radius


def make_pipe_distance(points: int) -> Callable[[Vector3, Any, float], float]:
    """Return (point, corners, radius) -> distance to a pipe that runs straight between so many corners, two or more."""
    return _make_pipe_from(points, 0)


def _make_pipe_from(points: int, first: int) -> Callable[[Vector3, Any, float], float]:
    second = first + 1

    def straight(point: Vector3, corners: Any, radius: float) -> float:
        return capsule_distance(point, corners[first], corners[second], radius)

    if second == points - 1:
        return straight
    rest = _make_pipe_from(points, second)

    def pipe(point: Vector3, corners: Any, radius: float) -> float:
        return min(straight(point, corners, radius), rest(point, corners, radius))

    return pipe
