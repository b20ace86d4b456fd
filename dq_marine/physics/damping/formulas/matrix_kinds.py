"""How a damping matrix with couplings is held: as all of its 36 numbers, or as a diagonal and what stands beside it.

Most hulls have a handful of numbers beside the diagonal. D M^-1 D, of which a kick takes the half, is 432 products of a
full matrix, and 72 and 12 for each number beside the diagonal of a sparse one. Both kinds offer the same operations, so
that one set of formulas serves both.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.entries import Places, add_products
from dq_marine.algebra.spatial import (
    Matrix6,
    Spatial,
    matrix6_add_diagonal,
    matrix6_add_scaled,
    matrix6_diagonal,
    matrix6_transform,
    spatial_multiply_elementwise,
)
from dq_marine.physics.damping.formulas.diagonal import (
    DiagonalDamping,
    diagonal_add_scaled,
    diagonal_at,
    diagonal_slope,
    full_at,
    full_sandwich,
    full_slope,
)
from dq_marine.physics.damping.formulas.matrix_entries import entry_place, scaled_columns, scaled_rows

Place: TypeAlias = tuple[int, int]
"""Row and column, each from 0 to 5, the angular part first."""

ZERO = Matrix6((0.0,) * 9, (0.0,) * 9, (0.0,) * 9, (0.0,) * 9)


class MatrixKind(NamedTuple):
    """The operations on one kind of matrix.

    own_at(damping, twist) is the linear part and the quadratic diagonal at a twist; own_slope(damping, twist) is the
    derivative of their drag, always with all 36 numbers; diagonal(D) is the diagonal; place(row, column) is where an
    entry stands among the numbers of D; the others are those of a `DampingAlgebra`.
    """

    own_at: Callable[..., Any]
    own_slope: Callable[..., Matrix6]
    diagonal: Callable[..., Spatial]
    place: Callable[[int, int], int]
    apply: Callable[..., Spatial]
    add_scaled: Callable[..., Matrix6]
    sandwich: Callable[..., Matrix6]


class SparseMatrix(NamedTuple):
    """A diagonal, and the numbers beside it in the order of their places."""

    diagonal: Spatial
    beside: Any


FULL_MATRIX = MatrixKind(
    own_at=full_at,
    own_slope=full_slope,
    diagonal=matrix6_diagonal,
    place=entry_place,
    apply=matrix6_transform,
    add_scaled=matrix6_add_scaled,
    sandwich=full_sandwich,
)
"""All 36 numbers."""


def sparse_own_slope(damping: DiagonalDamping, twist: Spatial) -> Matrix6:
    """Return d(D(chi) chi)/dchi of the diagonal alone."""
    return matrix6_add_diagonal(ZERO, diagonal_slope(damping, twist))


def sparse_diagonal(d: SparseMatrix) -> Spatial:
    """Return the diagonal."""
    return d.diagonal


@functools.cache
def sparse_matrix(places: tuple[Place, ...]) -> MatrixKind:
    """Return the operations on a diagonal with numbers at the given places beside it."""
    nothing = (0.0,) * len(places)
    numbered = [(index, row, column) for index, (row, column) in enumerate(places)]
    drags = Places((row, index, column) for index, row, column in numbered)
    entries = Places((entry_place(row, column), 0, index) for index, row, column in numbered)
    # A number beside the diagonal takes a column of m to another in m D, and a row of m to another in D m.
    columns = Places(
        (entry_place(i, column), index, entry_place(i, row))
        for index, row, column in numbered
        for i in range(6)
    )
    rows = Places(
        (entry_place(row, j), index, entry_place(column, j))
        for index, row, column in numbered
        for j in range(6)
    )

    def place(row: int, column: int) -> int:
        return row if row == column else 6 + places.index((row, column))

    def own_at(damping: DiagonalDamping, twist: Spatial) -> SparseMatrix:
        return SparseMatrix(diagonal_at(damping, twist), nothing)

    def apply(d: SparseMatrix, twist: Spatial) -> Spatial:
        return add_products(drags, spatial_multiply_elementwise(d.diagonal, twist), d.beside, twist)

    def add_scaled_sparse(m: Matrix6, s: float, d: SparseMatrix) -> Matrix6:
        return add_products(entries, diagonal_add_scaled(m, s, d.diagonal), s, d.beside)

    def sandwich(d: SparseMatrix, m: Matrix6) -> Matrix6:
        right = add_products(columns, scaled_columns(m, d.diagonal), d.beside, m)
        return add_products(rows, scaled_rows(d.diagonal, right), d.beside, right)

    return MatrixKind(own_at, sparse_own_slope, sparse_diagonal, place, apply, add_scaled_sparse, sandwich)
