"""Sizes of a mass matrix's entries that do not depend on units: M_ij over sqrt(M_ii M_jj)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class LargestEntry(NamedTuple):
    """The largest entry of a matrix in magnitude.

    Attributes:
        value: its magnitude.
        row: its row, the smaller index of a symmetric pair.
        column: its column.
    """

    value: float
    row: int
    column: int


def unit_free(matrix: Array, mass_matrix: Array) -> Array:
    """Return A_ij / sqrt(M_ii M_jj), shape (6, 6), for M with a positive diagonal.

    For a positive definite M itself, all entries off the diagonal lie between -1 and 1.
    """
    scale = np.sqrt(np.diag(mass_matrix))
    return np.asarray(matrix / np.outer(scale, scale))


def largest_coupling(mass_matrix: Array) -> LargestEntry:
    """Return the largest |M_ij| / sqrt(M_ii M_jj) with i < j."""
    return _largest(np.triu(unit_free(mass_matrix, mass_matrix), 1))


def asymmetry(matrix: Array, mass_matrix: Array) -> LargestEntry:
    """Return the largest |A_ij - A_ji| / sqrt(M_ii M_jj) with i < j."""
    return _largest(np.triu(unit_free(matrix - matrix.T, mass_matrix), 1))


def _largest(matrix: Array) -> LargestEntry:
    row, column = np.unravel_index(int(np.abs(matrix).argmax()), matrix.shape)
    return LargestEntry(float(abs(matrix[row, column])), int(row), int(column))
