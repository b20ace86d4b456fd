"""3x3 matrices, as tuples of nine components in row-major order."""

from __future__ import annotations

import math
from typing import TypeAlias

from dq_marine.algebra.selection import by_precision, every, negation
from dq_marine.algebra.vector3 import Vector3

Matrix3: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]


DOUBLE_ROOT = 1e-10
"""Of a cubic's terms: below this its minimum counts as zero."""

DOUBLE_ROOT_SINGLE = 1e-5
"""`DOUBLE_ROOT` where numbers have single precision."""

ROUND_OFF = 1e-15
"""Of the sums of products of three entries, over the cube of the matrix's norm."""

ROUND_OFF_SINGLE = 5e-7
"""`ROUND_OFF` where numbers have single precision."""


def transform(m: Matrix3, a: Vector3) -> Vector3:
    """Return m a."""
    return (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
        m[6] * a[0] + m[7] * a[1] + m[8] * a[2],
    )


def matrix_add(a: Matrix3, b: Matrix3) -> Matrix3:
    """Return a + b."""
    return (
        a[0] + b[0],
        a[1] + b[1],
        a[2] + b[2],
        a[3] + b[3],
        a[4] + b[4],
        a[5] + b[5],
        a[6] + b[6],
        a[7] + b[7],
        a[8] + b[8],
    )


def matrix_scale(s: float, a: Matrix3) -> Matrix3:
    """Return s a."""
    return (
        s * a[0],
        s * a[1],
        s * a[2],
        s * a[3],
        s * a[4],
        s * a[5],
        s * a[6],
        s * a[7],
        s * a[8],
    )


def matrix_subtract(a: Matrix3, b: Matrix3) -> Matrix3:
    """Return a - b."""
    return matrix_add(a, matrix_scale(-1.0, b))


def add_diagonal(a: Matrix3, d: Vector3) -> Matrix3:
    """Return a + diag(d)."""
    return (a[0] + d[0], a[1], a[2], a[3], a[4] + d[1], a[5], a[6], a[7], a[8] + d[2])


def scale_rows_and_columns(rows: Vector3, a: Matrix3, columns: Vector3) -> Matrix3:
    """Return diag(rows) a diag(columns)."""
    return (
        rows[0] * a[0] * columns[0],
        rows[0] * a[1] * columns[1],
        rows[0] * a[2] * columns[2],
        rows[1] * a[3] * columns[0],
        rows[1] * a[4] * columns[1],
        rows[1] * a[5] * columns[2],
        rows[2] * a[6] * columns[0],
        rows[2] * a[7] * columns[1],
        rows[2] * a[8] * columns[2],
    )


def matrix_multiply(a: Matrix3, b: Matrix3) -> Matrix3:
    """Return a b."""
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )


def matrix_from_columns(a: Vector3, b: Vector3, c: Vector3) -> Matrix3:
    """Return the matrix whose columns are a, b and c."""
    return (a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2])


def cross_matrix(a: Vector3) -> Matrix3:
    """Return the matrix that takes b to a x b."""
    return (0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0)


def adjugate(a: Matrix3) -> Matrix3:
    """Return the adjugate of a: adj(a) a = det(a) 1."""
    return (
        a[4] * a[8] - a[5] * a[7],
        a[2] * a[7] - a[1] * a[8],
        a[1] * a[5] - a[2] * a[4],
        a[5] * a[6] - a[3] * a[8],
        a[0] * a[8] - a[2] * a[6],
        a[2] * a[3] - a[0] * a[5],
        a[3] * a[7] - a[4] * a[6],
        a[1] * a[6] - a[0] * a[7],
        a[0] * a[4] - a[1] * a[3],
    )


def determinant(a: Matrix3) -> float:
    """Return det(a)."""
    return (
        a[0] * (a[4] * a[8] - a[5] * a[7])
        + a[1] * (a[5] * a[6] - a[3] * a[8])
        + a[2] * (a[3] * a[7] - a[4] * a[6])
    )


def trace(a: Matrix3) -> float:
    """Return the sum of the diagonal."""
    return a[0] + a[4] + a[8]


def sum_of_principal_minors(a: Matrix3) -> float:
    """Return the second invariant, the sum of the eigenvalues' products in pairs."""
    return trace(adjugate(a))


def sum_of_squares(a: Matrix3) -> float:
    """Return the square of the Frobenius norm."""
    upper = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3] + a[4] * a[4]
    return upper + a[5] * a[5] + a[6] * a[6] + a[7] * a[7] + a[8] * a[8]


def has_negative_real_eigenvalue(a: Matrix3) -> bool:
    """Whether a real eigenvalue of a is zero or negative; True for NaN.

    Those are the roots -mu, mu >= 0, of the characteristic polynomial: f(mu) = mu^3 + c2 mu^2 + c1 mu + c0 with
    the invariants as coefficients, all positive as a rule, and then there is none. Else f(0) = c0 must be positive,
    and so must f where it is smallest on mu > 0, beyond round-off: two equal eigenvalues make it zero there. Round-off
    is that of f's terms, and that of its coefficients, which are sums of products of a's entries.
    """
    c2, c1, c0 = trace(a), sum_of_principal_minors(a), determinant(a)
    all_positive = (c2 > 0.0) & (c1 > 0.0) & (c0 > 0.0)
    if every(all_positive):
        return negation(all_positive)
    discriminant = c2 * c2 - 3.0 * c1
    lowest = (math.sqrt(max(discriminant, 0.0)) - c2) / 3.0
    rises = (discriminant <= 0.0) | (lowest <= 0.0)  # f has no minimum on mu > 0
    double_root = by_precision(c0, DOUBLE_ROOT, DOUBLE_ROOT_SINGLE)
    size = ((lowest + abs(c2)) * lowest + abs(c1)) * lowest + c0
    entries = math.sqrt(sum_of_squares(a))
    round_off = (
        double_root * size + by_precision(c0, ROUND_OFF, ROUND_OFF_SINGLE) * entries * entries * entries
    )
    positive_there = ((lowest + c2) * lowest + c1) * lowest + c0 > round_off
    return negation((c0 > 0.0) & (rises | positive_there))


def invert(a: Matrix3) -> Matrix3:
    """Return the inverse of a; infinite or NaN components where a is singular (Python's own floats raise there)."""
    return matrix_scale(1.0 / determinant(a), adjugate(a))
