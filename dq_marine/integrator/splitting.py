"""The lower triangle that stands for a collocation method's matrix in Newton's method, in its own coordinates.

With A = L U by Crout, U with ones on its diagonal, Newton's method for the stages is iterated with L in place of A: it
converges at any stiffness, and fast (van der Houwen, de Swart 1997, SIAM J. Sci. Comput. 18, 41). The diagonal of L
has no number twice, so L = Q diag(d) Q^-1, and the stages part: one system for each.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

from dq_marine.integrator.collocation import Collocation

Rows = tuple[tuple[float, ...], ...]


class Splitting(NamedTuple):
    """L = Q diag(d) Q^-1.

    Attributes:
        diagonal: d.
        together: Q, from the coordinates in which the stages part to the stages.
        apart: Q^-1.
    """

    diagonal: tuple[float, ...]
    together: Rows
    apart: Rows


@functools.cache
def splitting(method: Collocation) -> Splitting:
    """Return the splitting of a method's matrix."""
    lower = crout(method.matrix)
    count = range(len(lower))
    together = [[float(i == j) for j in count] for i in count]
    apart = [[float(i == j) for j in count] for i in count]
    for j in count:
        for i in count[j + 1 :]:
            coupled = sum(lower[i][k] * together[k][j] for k in count[j:i])
            together[i][j] = coupled / (lower[j][j] - lower[i][i])  # L q_j = d_j q_j, row by row
    for j in count:
        for i in count[j + 1 :]:
            apart[i][j] = -sum(together[i][k] * apart[k][j] for k in count[j:i])
    return Splitting(tuple(lower[i][i] for i in count), rows(together), rows(apart))


def crout(matrix: Rows) -> list[list[float]]:
    """Return the lower factor L of a matrix L U, where U has ones on its diagonal."""
    count = range(len(matrix))
    lower = [[0.0 for _ in count] for _ in count]
    upper = [[float(i == j) for j in count] for i in count]
    for j in count:
        for i in count[j:]:
            lower[i][j] = matrix[i][j] - sum(lower[i][k] * upper[k][j] for k in count[:j])
        for i in count[j + 1 :]:
            upper[j][i] = (matrix[j][i] - sum(lower[j][k] * upper[k][i] for k in count[:j])) / lower[j][j]
    return lower


def rows(matrix: list[list[float]]) -> Rows:
    """Return a matrix as tuples."""
    return tuple(map(tuple, matrix))
