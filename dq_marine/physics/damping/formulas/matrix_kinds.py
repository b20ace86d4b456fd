"""How a damping matrix with couplings is held: as all of its 36 numbers, or as a diagonal and what stands beside it.

Most hulls have a handful of numbers beside the diagonal. D M^-1 D, of which a kick takes the half, is 432 products of a
full matrix, and 72 and 12 for each number beside the diagonal of a sparse one. Both kinds offer the same operations, so
that one set of formulas serves both.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.nesting import folded
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
from dq_marine.physics.damping.formulas.matrix_entries import (
    make_column_to_column,
    make_component,
    make_component_addition,
    make_entry_addition,
    make_row_to_row,
    scaled_columns,
    scaled_rows,
)

Place: TypeAlias = tuple[int, int]
"""Row and column, each from 0 to 5, the angular part first."""

ZERO = Matrix6((0.0,) * 9, (0.0,) * 9, (0.0,) * 9, (0.0,) * 9)


class MatrixKind(NamedTuple):
    """The operations on one kind of matrix.

    own_at(damping, twist) is the linear part and the quadratic diagonal at a twist; own_slope(damping, twist) is the
    derivative of their drag, always with all 36 numbers; diagonal(D) is the diagonal; make_entry_addition(row, column)
    returns (D, value) -> D with a value added to one entry; the others are those of a `DampingAlgebra`.
    """

    own_at: Callable[..., Any]
    own_slope: Callable[..., Matrix6]
    diagonal: Callable[..., Spatial]
    make_entry_addition: Callable[[int, int], Callable[..., Any]]
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
    make_entry_addition=make_entry_addition,
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

    def own_at(damping: DiagonalDamping, twist: Spatial) -> SparseMatrix:
        return SparseMatrix(diagonal_at(damping, twist), nothing)

    def make_sparse_addition(row: int, column: int) -> Callable[..., SparseMatrix]:
        if row == column:
            add_component = make_component_addition(row)

            def add_to_diagonal(d: SparseMatrix, value: float) -> SparseMatrix:
                return SparseMatrix(add_component(d.diagonal, value), d.beside)

            return add_to_diagonal
        place = places.index((row, column))
        after = place + 1

        def add_beside(d: SparseMatrix, value: float) -> SparseMatrix:
            before, rest = d.beside[:place], d.beside[after:]
            return SparseMatrix(d.diagonal, before + (d.beside[place] + value,) + rest)  # noqa: RUF005

        return add_beside

    numbered = tuple(enumerate(places))
    add_drags = folded(link_drag, numbered, no_more_drag)
    add_numbers = folded(link_number, numbered, no_more_numbers)
    add_columns = folded(link_columns, numbered, no_more_products)
    add_rows = folded(link_rows, numbered, no_more_products)

    def apply(d: SparseMatrix, twist: Spatial) -> Spatial:
        return add_drags(d.beside, twist, spatial_multiply_elementwise(d.diagonal, twist))

    def add_scaled_sparse(m: Matrix6, s: float, d: SparseMatrix) -> Matrix6:
        return add_numbers(d.beside, s, diagonal_add_scaled(m, s, d.diagonal))

    def sandwich(d: SparseMatrix, m: Matrix6) -> Matrix6:
        right = add_columns(d.beside, m, scaled_columns(m, d.diagonal))
        return add_rows(d.beside, right, scaled_rows(d.diagonal, right))

    return MatrixKind(
        own_at, sparse_own_slope, sparse_diagonal, make_sparse_addition, apply, add_scaled_sparse, sandwich
    )


def no_more_drag(beside: Any, twist: Spatial, drag: Spatial) -> Spatial:
    """Return the drag as it is."""
    return drag


def no_more_numbers(beside: Any, s: float, m: Matrix6) -> Matrix6:
    """Return the matrix as it is."""
    return m


def no_more_products(beside: Any, m: Matrix6, product: Matrix6) -> Matrix6:
    """Return the product as it is."""
    return product


def link_drag(numbered: tuple[int, Place], rest: Callable[..., Spatial]) -> Callable[..., Spatial]:
    """Return (beside, twist, drag) -> the drag with that of one number and of the rest."""
    index, (row, column) = numbered
    add_component, component = make_component_addition(row), make_component(column)

    def add_drag(beside: Any, twist: Spatial, drag: Spatial) -> Spatial:
        return rest(beside, twist, add_component(drag, beside[index] * component(twist)))

    return add_drag


def link_number(numbered: tuple[int, Place], rest: Callable[..., Matrix6]) -> Callable[..., Matrix6]:
    """Return (beside, s, m) -> m with s times one number and the rest."""
    index, (row, column) = numbered
    add_entry = make_entry_addition(row, column)

    def add_number(beside: Any, s: float, m: Matrix6) -> Matrix6:
        return rest(beside, s, add_entry(m, s * beside[index]))

    return add_number


def link_columns(numbered: tuple[int, Place], rest: Callable[..., Matrix6]) -> Callable[..., Matrix6]:
    """Return (beside, m, product) -> m D from its part by the diagonal: one number takes a column of m to another."""
    index, (row, column) = numbered
    add_column = make_column_to_column(row, column)

    def add_columns(beside: Any, m: Matrix6, product: Matrix6) -> Matrix6:
        return rest(beside, m, add_column(product, beside[index], m))

    return add_columns


def link_rows(numbered: tuple[int, Place], rest: Callable[..., Matrix6]) -> Callable[..., Matrix6]:
    """Return (beside, m, product) -> D m from its part by the diagonal: one number takes a row of m to another."""
    index, (row, column) = numbered
    add_row = make_row_to_row(column, row)

    def add_rows(beside: Any, m: Matrix6, product: Matrix6) -> Matrix6:
        return rest(beside, m, add_row(product, beside[index], m))

    return add_rows
