"""Single entries of matrices and spatial vectors, by indices that are known before compilation.

Indices count from 0 to 5, the angular part first.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from dq_marine.algebra.entries import Places, add_products
from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.spatial import Matrix6, Spatial
from dq_marine.algebra.vector3 import Vector3


@functools.cache
def make_component(index: int) -> Callable[[Spatial], float]:
    """Return the function that takes one of the six components of a spatial vector."""
    place = index % 3

    def angular_component(a: Spatial) -> float:
        return a.angular[place]

    def linear_component(a: Spatial) -> float:
        return a.linear[place]

    return angular_component if index < 3 else linear_component


def entry_place(row: int, column: int) -> int:
    """Return where an entry stands among the 36 numbers of a `Matrix6`."""
    return 9 * (2 * (row // 3) + column // 3) + 3 * (row % 3) + column % 3


@functools.cache
def make_entry_addition(place: int) -> Callable[[Any, float], Any]:
    """Return (m, value) -> m with a value added to the number that stands at a place, whatever kind of matrix m is."""
    there = Places([(place, 0, 0)])

    def add_entry(m: Any, value: float) -> Any:
        return add_products(there, m, value, 1.0)

    return add_entry


def scaled_columns(m: Matrix6, d: Spatial) -> Matrix6:
    """Return m diag(d)."""
    return Matrix6(
        scale_columns(m.angular, d.angular),
        scale_columns(m.angular_linear, d.linear),
        scale_columns(m.linear_angular, d.angular),
        scale_columns(m.linear, d.linear),
    )


def scaled_rows(d: Spatial, m: Matrix6) -> Matrix6:
    """Return diag(d) m."""
    return Matrix6(
        scale_rows(d.angular, m.angular),
        scale_rows(d.angular, m.angular_linear),
        scale_rows(d.linear, m.linear_angular),
        scale_rows(d.linear, m.linear),
    )


def scale_columns(m: Matrix3, d: Vector3) -> Matrix3:
    """Return m diag(d)."""
    x, y, z = d
    return (m[0] * x, m[1] * y, m[2] * z, m[3] * x, m[4] * y, m[5] * z, m[6] * x, m[7] * y, m[8] * z)


def scale_rows(d: Vector3, m: Matrix3) -> Matrix3:
    """Return diag(d) m."""
    x, y, z = d
    return (x * m[0], x * m[1], x * m[2], y * m[3], y * m[4], y * m[5], z * m[6], z * m[7], z * m[8])
