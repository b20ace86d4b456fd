"""Single entries, rows and columns of matrices and spatial vectors, by indices that are known before compilation.

Indices count from 0 to 5, the angular part first.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.spatial import Matrix6, Spatial
from dq_marine.algebra.vector3 import Vector3, add_scaled


@functools.cache
def make_component(index: int) -> Callable[[Spatial], float]:
    """Return the function that takes one of the six components of a spatial vector."""
    place = index % 3

    def angular_component(a: Spatial) -> float:
        return a.angular[place]

    def linear_component(a: Spatial) -> float:
        return a.linear[place]

    return angular_component if index < 3 else linear_component


@functools.cache
def make_component_addition(index: int) -> Callable[[Spatial, float], Spatial]:
    """Return (a, value) -> a with a value added to one component."""
    place = index % 3
    after = place + 1

    def raised(part: Any, value: float) -> Any:
        return part[:place] + (part[place] + value,) + part[after:]  # noqa: RUF005 - compiled code knows no star

    def add_angular(a: Spatial, value: float) -> Spatial:
        return Spatial(raised(a.angular, value), a.linear)

    def add_linear(a: Spatial, value: float) -> Spatial:
        return Spatial(a.angular, raised(a.linear, value))

    return add_angular if index < 3 else add_linear


@functools.cache
def make_entry_addition(row: int, column: int) -> Callable[[Matrix6, float], Matrix6]:
    """Return (m, value) -> m with a value added to one entry."""
    place = 3 * (row % 3) + column % 3
    after = place + 1

    def raised(block: Matrix3, value: float) -> Any:
        return block[:place] + (block[place] + value,) + block[after:]  # noqa: RUF005 - compiled code knows no star

    def add_angular(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(raised(m.angular, value), m.angular_linear, m.linear_angular, m.linear)

    def add_angular_linear(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, raised(m.angular_linear, value), m.linear_angular, m.linear)

    def add_linear_angular(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, m.angular_linear, raised(m.linear_angular, value), m.linear)

    def add_linear(m: Matrix6, value: float) -> Matrix6:
        return Matrix6(m.angular, m.angular_linear, m.linear_angular, raised(m.linear, value))

    if row < 3:
        return add_angular if column < 3 else add_angular_linear
    return add_linear_angular if column < 3 else add_linear


@functools.cache
def make_column_to_column(source: int, target: int) -> Callable[[Matrix6, float, Matrix6], Matrix6]:
    """Return (m, s, a) -> m with s times a column of a added to a column of m."""
    p, q = source % 3, target % 3
    p_middle, p_low, q_middle, q_low = p + 3, p + 6, q + 3, q + 6
    after_top, after_middle, after_low = q + 1, q + 4, q + 7

    def raised(block: Matrix3, s: float, a: Matrix3) -> Any:
        top = block[:q] + (block[q] + s * a[p],)  # noqa: RUF005 - compiled code knows no star
        middle = block[after_top:q_middle] + (block[q_middle] + s * a[p_middle],)  # noqa: RUF005
        low = block[after_middle:q_low] + (block[q_low] + s * a[p_low],)  # noqa: RUF005
        return top + middle + low + block[after_low:]

    def angular_column(a: Matrix6) -> tuple[Matrix3, Matrix3]:
        return (a.angular, a.linear_angular)

    def linear_column(a: Matrix6) -> tuple[Matrix3, Matrix3]:
        return (a.angular_linear, a.linear)

    column_of = angular_column if source < 3 else linear_column

    def add_to_angular(m: Matrix6, s: float, a: Matrix6) -> Matrix6:
        above, below = column_of(a)
        return Matrix6(
            raised(m.angular, s, above), m.angular_linear, raised(m.linear_angular, s, below), m.linear
        )

    def add_to_linear(m: Matrix6, s: float, a: Matrix6) -> Matrix6:
        above, below = column_of(a)
        return Matrix6(
            m.angular, raised(m.angular_linear, s, above), m.linear_angular, raised(m.linear, s, below)
        )

    return add_to_angular if target < 3 else add_to_linear


@functools.cache
def make_row_to_row(source: int, target: int) -> Callable[[Matrix6, float, Matrix6], Matrix6]:
    """Return (m, s, a) -> m with s times a row of a added to a row of m."""
    p, q = 3 * (source % 3), 3 * (target % 3)
    p_end, q_end = p + 3, q + 3

    def raised(block: Matrix3, s: float, a: Matrix3) -> Any:
        before: Any = block[q:q_end]
        added: Any = a[p:p_end]
        return block[:q] + add_scaled(before, s, added) + block[q_end:]

    def angular_row(a: Matrix6) -> tuple[Matrix3, Matrix3]:
        return (a.angular, a.angular_linear)

    def linear_row(a: Matrix6) -> tuple[Matrix3, Matrix3]:
        return (a.linear_angular, a.linear)

    row_of = angular_row if source < 3 else linear_row

    def add_to_angular(m: Matrix6, s: float, a: Matrix6) -> Matrix6:
        left, right = row_of(a)
        return Matrix6(
            raised(m.angular, s, left), raised(m.angular_linear, s, right), m.linear_angular, m.linear
        )

    def add_to_linear(m: Matrix6, s: float, a: Matrix6) -> Matrix6:
        left, right = row_of(a)
        return Matrix6(
            m.angular, m.angular_linear, raised(m.linear_angular, s, left), raised(m.linear, s, right)
        )

    return add_to_angular if target < 3 else add_to_linear


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
