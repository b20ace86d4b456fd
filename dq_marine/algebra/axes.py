"""The three coordinate axes e as operations on vectors, without the products with the zeros of e.

A compiler must keep those products, for 0 times infinity is not 0; a Jacobian by columns is full of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.vector3 import Vector3


class Axis(NamedTuple):
    """Operations with one axis e.

    Attributes:
        along: (a) -> e . a.
        column: (m) -> m e.
        lengthen: (a, s) -> a + s e.
        turned: (s, a) -> s (e + e x a).
        add_cross: (a, s, b) -> a + s e x b.
    """

    along: Callable[[Vector3], float]
    column: Callable[[Matrix3], Vector3]
    lengthen: Callable[[Vector3, float], Vector3]
    turned: Callable[[float, Vector3], Vector3]
    add_cross: Callable[[Vector3, float, Vector3], Vector3]


def along_x(a: Vector3) -> float:
    """Return x . a."""
    return a[0]


def along_y(a: Vector3) -> float:
    """Return y . a."""
    return a[1]


def along_z(a: Vector3) -> float:
    """Return z . a."""
    return a[2]


def column_x(m: Matrix3) -> Vector3:
    """Return m x."""
    return (m[0], m[3], m[6])


def column_y(m: Matrix3) -> Vector3:
    """Return m y."""
    return (m[1], m[4], m[7])


def column_z(m: Matrix3) -> Vector3:
    """Return m z."""
    return (m[2], m[5], m[8])


def lengthen_x(a: Vector3, s: float) -> Vector3:
    """Return a + s x."""
    return (a[0] + s, a[1], a[2])


def lengthen_y(a: Vector3, s: float) -> Vector3:
    """Return a + s y."""
    return (a[0], a[1] + s, a[2])


def lengthen_z(a: Vector3, s: float) -> Vector3:
    """Return a + s z."""
    return (a[0], a[1], a[2] + s)


def turned_x(s: float, a: Vector3) -> Vector3:
    """Return s (x + x x a)."""
    return (s, -s * a[2], s * a[1])


def turned_y(s: float, a: Vector3) -> Vector3:
    """Return s (y + y x a)."""
    return (s * a[2], s, -s * a[0])


def turned_z(s: float, a: Vector3) -> Vector3:
    """Return s (z + z x a)."""
    return (-s * a[1], s * a[0], s)


def add_cross_x(a: Vector3, s: float, b: Vector3) -> Vector3:
    """Return a + s x x b."""
    return (a[0], a[1] - s * b[2], a[2] + s * b[1])


def add_cross_y(a: Vector3, s: float, b: Vector3) -> Vector3:
    """Return a + s y x b."""
    return (a[0] + s * b[2], a[1], a[2] - s * b[0])


def add_cross_z(a: Vector3, s: float, b: Vector3) -> Vector3:
    """Return a + s z x b."""
    return (a[0] - s * b[1], a[1] + s * b[0], a[2])


X_AXIS = Axis(along_x, column_x, lengthen_x, turned_x, add_cross_x)
Y_AXIS = Axis(along_y, column_y, lengthen_y, turned_y, add_cross_y)
Z_AXIS = Axis(along_z, column_z, lengthen_z, turned_z, add_cross_z)
