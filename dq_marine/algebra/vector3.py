"""Vectors of three components, as tuples (x, y, z)."""

from __future__ import annotations

import math
from typing import TypeAlias

Vector3: TypeAlias = tuple[float, float, float]


def add(a: Vector3, b: Vector3) -> Vector3:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector3, b: Vector3) -> Vector3:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(s: float, a: Vector3) -> Vector3:
    """Return s a."""
    return (s * a[0], s * a[1], s * a[2])


def add_scaled(a: Vector3, s: float, b: Vector3) -> Vector3:
    """Return a + s b."""
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def dot(a: Vector3, b: Vector3) -> float:
    """Return the scalar product a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector3, b: Vector3) -> Vector3:
    """Return the vector product a x b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def multiply_elementwise(a: Vector3, b: Vector3) -> Vector3:
    """Return (a_i b_i)."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def absolute(a: Vector3) -> Vector3:
    """Return (|a_i|)."""
    return (abs(a[0]), abs(a[1]), abs(a[2]))


def clamp(limit: float, a: Vector3) -> Vector3:
    """Return a with every component between -limit and limit."""
    return (
        max(-limit, min(limit, a[0])),
        max(-limit, min(limit, a[1])),
        max(-limit, min(limit, a[2])),
    )


def bounded(value: float, bound: float) -> float:
    """Return value, held within -bound and bound."""
    return max(-bound, min(bound, value))


def bounded_vector(a: Vector3, bound: float) -> Vector3:
    """Return a with each component held within -bound and bound."""
    return (bounded(a[0], bound), bounded(a[1], bound), bounded(a[2], bound))


def norm(a: Vector3) -> float:
    """Return |a|."""
    return math.sqrt(dot(a, a))
