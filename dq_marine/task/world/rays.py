"""Rays: how far it is along a unit direction to a shape [m]; the reach where there is nothing, 0 from inside.

Spheres, pillars, straight pipes, boxes and planes have closed forms. With a ray at o + t d, a centre at distance vector
m = c - o, and of d and m only the parts across a pillar or a pipe, the first of the two roots of

    (d.d) t^2 - 2 (d.m) t + (m.m - r^2) = 0                                                            (1)

is (m.m - r^2) / (d.m + sqrt((d.m)^2 - (d.d)(m.m - r^2))), which divides by no difference (Press et al. 2007, Numerical
Recipes, 5.6). Other shapes are met by sphere tracing: on by the distance to the nearest surface, again and again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from dq_marine.algebra.selection import select, smallest_normal
from dq_marine.algebra.vector3 import Vector3, add_scaled, dot, subtract

PARALLEL = 1e-12
"""Components of a direction that are smaller count as this: the slab of a box is then entered nowhere near."""


def first_root(squared: float, along: float, power: float, reach: float) -> float:
    """Return the range by (1), from d.d, d.m and m.m - r^2."""
    under = along * along - squared * power
    root = math.sqrt(max(under, 0.0))
    distance = max(power, 0.0) / max(along + root, smallest_normal(along))
    met = (power <= 0.0) | ((under >= 0.0) & (along > 0.0))
    return select(met, min(distance, reach), reach)


def ray_to_sphere(origin: Vector3, direction: Vector3, center: Vector3, radius: float, reach: float) -> float:
    """Return the range to a sphere."""
    off = subtract(center, origin)
    return first_root(dot(direction, direction), dot(direction, off), dot(off, off) - radius * radius, reach)


def ray_to_pillar(
    origin: Vector3, direction: Vector3, north: float, east: float, radius: float, reach: float
) -> float:
    """Return the range to a vertical cylinder without ends."""
    x, y, u, v = north - origin[0], east - origin[1], direction[0], direction[1]
    return first_root(u * u + v * v, u * x + v * y, x * x + y * y - radius * radius, reach)


def ray_to_line(
    origin: Vector3, direction: Vector3, on_axis: Vector3, axis: Vector3, radius: float, reach: float
) -> float:
    """Return the range to a straight pipe without ends, whose axis is a unit vector through a point."""
    off = subtract(on_axis, origin)
    across, beside = (
        add_scaled(direction, -dot(direction, axis), axis),
        add_scaled(off, -dot(off, axis), axis),
    )
    return first_root(dot(across, across), dot(across, beside), dot(beside, beside) - radius * radius, reach)


def ray_to_plane(origin: Vector3, direction: Vector3, normal: Vector3, offset: float, reach: float) -> float:
    """Return the range to the plane n . p = offset, from the side that n points to; behind it is inside."""
    height, sinking = max(dot(normal, origin) - offset, 0.0), -dot(normal, direction)
    distance = height / max(sinking, smallest_normal(sinking))
    return select((sinking > 0.0) | (height <= 0.0), min(distance, reach), reach)


def ray_to_box(
    origin: Vector3, direction: Vector3, center: Vector3, half_size: Vector3, reach: float
) -> float:
    """Return the range to a box along the axes: where the ray is in all three of its slabs (Kay & Kajiya 1986).

    A ray that runs in a face, and never comes within, may meet the box or not.
    """
    x0, x1 = _slab(origin[0] - center[0], direction[0], half_size[0])
    y0, y1 = _slab(origin[1] - center[1], direction[1], half_size[1])
    z0, z1 = _slab(origin[2] - center[2], direction[2], half_size[2])
    entered, left = max(x0, max(y0, z0)), min(x1, min(y1, z1))
    met = (entered <= left) & (left >= 0.0)
    return select(met, min(max(entered, 0.0), reach), reach)


def make_trace(
    distance: Callable[[Any, Vector3], float], steps: int
) -> Callable[[Any, Vector3, Vector3, float], float]:
    """Return (shape, origin, direction, reach) -> range by sphere tracing (Hart 1996), which never passes a surface.

    Args:
        distance: (shape, point) -> distance to the shape, or less; it changes by no more than the point moves.
        steps: of the march; what is left of the range shrinks by a fixed factor in each.
    """

    def trace(shape: Any, origin: Vector3, direction: Vector3, reach: float) -> float:
        travelled = 0.0 * origin[0]
        for _ in range(steps):
            free = distance(shape, add_scaled(origin, travelled, direction))
            travelled = min(travelled + max(free, 0.0), reach)
        return travelled

    return trace


def _slab(off: float, slope: float, half: float) -> tuple[float, float]:
    """Return when a ray enters and leaves -half <= off + t slope <= half."""
    safe = select(abs(slope) < PARALLEL, PARALLEL, slope)
    one, other = (-half - off) / safe, (half - off) / safe
    return min(one, other), max(one, other)
