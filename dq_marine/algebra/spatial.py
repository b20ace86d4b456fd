"""Spatial vectors (twist, momentum, wrench) and the 6x6 matrices between them, in 3x3 blocks.

The angular part stands first: twist chi = [omega; v], momentum mu = M chi, wrench [moment; force].
`from_fossen` and `to_fossen` are where the order of vectors changes, `physics.matrices.angular_first` that of matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.matrix3 import (
    Matrix3,
    add_diagonal,
    invert,
    matrix_add,
    matrix_multiply,
    matrix_scale,
    matrix_subtract,
    scale_rows_and_columns,
    transform,
)
from dq_marine.algebra.vector3 import (
    Vector3,
    absolute,
    add,
    add_scaled,
    cross,
    dot,
    multiply_elementwise,
    scale,
    subtract,
)

Fossen6: TypeAlias = tuple[float, float, float, float, float, float]


ANGULAR_FIRST = (3, 4, 5, 0, 1, 2)
"""Where the components of Fossen's order stand among those of a spatial vector, and the other way round."""


class Spatial(NamedTuple):
    """A twist, a momentum or a wrench: angular part [rad/s, N m s, N m], linear part [m/s, N s, N]."""

    angular: Vector3
    linear: Vector3


ZERO = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""No wrench, and the twist and the momentum of a body at rest."""


class Matrix6(NamedTuple):
    """A 6x6 matrix on spatial vectors: [[angular, angular_linear], [linear_angular, linear]]."""

    angular: Matrix3
    angular_linear: Matrix3
    linear_angular: Matrix3
    linear: Matrix3


def wrench_at(point: Vector3, force: Vector3) -> Spatial:
    """Return moment and force about the origin of a force that acts at a point [m]."""
    return Spatial(cross(point, force), force)


def from_fossen(components: Sequence[float]) -> Spatial:
    """Return the spatial vector of nu = (u, v, w, p, q, r) or tau = (X, Y, Z, K, M, N)."""
    return Spatial(
        (components[3], components[4], components[5]),
        (components[0], components[1], components[2]),
    )


def to_fossen(a: Spatial) -> Fossen6:
    """Return the components of a in Fossen's order, linear part first."""
    return (a.linear[0], a.linear[1], a.linear[2], a.angular[0], a.angular[1], a.angular[2])


def spatial_add(a: Spatial, b: Spatial) -> Spatial:
    """Return a + b."""
    return Spatial(add(a.angular, b.angular), add(a.linear, b.linear))


def spatial_subtract(a: Spatial, b: Spatial) -> Spatial:
    """Return a - b."""
    return Spatial(subtract(a.angular, b.angular), subtract(a.linear, b.linear))


def spatial_add_scaled(a: Spatial, s: float, b: Spatial) -> Spatial:
    """Return a + s b."""
    return Spatial(add_scaled(a.angular, s, b.angular), add_scaled(a.linear, s, b.linear))


def spatial_scale(s: float, a: Spatial) -> Spatial:
    """Return s a."""
    return Spatial(scale(s, a.angular), scale(s, a.linear))


def spatial_multiply_elementwise(a: Spatial, b: Spatial) -> Spatial:
    """Return (a_i b_i)."""
    return Spatial(multiply_elementwise(a.angular, b.angular), multiply_elementwise(a.linear, b.linear))


def spatial_absolute(a: Spatial) -> Spatial:
    """Return (|a_i|)."""
    return Spatial(absolute(a.angular), absolute(a.linear))


def spatial_dot(a: Spatial, b: Spatial) -> float:
    """Return the pairing of a and b: power, for a wrench and a twist."""
    return dot(a.angular, b.angular) + dot(a.linear, b.linear)


def quadratic_form(m: Matrix6, a: Spatial) -> float:
    """Return a . m a of a symmetric m."""
    coupled = dot(a.angular, transform(m.angular_linear, a.linear))
    own = dot(a.angular, transform(m.angular, a.angular)) + dot(a.linear, transform(m.linear, a.linear))
    return own + (coupled + coupled)


def matrix6_transform(m: Matrix6, a: Spatial) -> Spatial:
    """Return m a."""
    return Spatial(
        add(transform(m.angular, a.angular), transform(m.angular_linear, a.linear)),
        add(transform(m.linear_angular, a.angular), transform(m.linear, a.linear)),
    )


def matrix6_add_scaled(a: Matrix6, s: float, b: Matrix6) -> Matrix6:
    """Return a + s b."""
    return Matrix6(
        matrix_add(a.angular, matrix_scale(s, b.angular)),
        matrix_add(a.angular_linear, matrix_scale(s, b.angular_linear)),
        matrix_add(a.linear_angular, matrix_scale(s, b.linear_angular)),
        matrix_add(a.linear, matrix_scale(s, b.linear)),
    )


def matrix6_diagonal(m: Matrix6) -> Spatial:
    """Return the diagonal of m."""
    a, d = m.angular, m.linear
    return Spatial((a[0], a[4], a[8]), (d[0], d[4], d[8]))


def matrix6_add_diagonal(m: Matrix6, d: Spatial) -> Matrix6:
    """Return m + diag(d)."""
    return Matrix6(
        add_diagonal(m.angular, d.angular),
        m.angular_linear,
        m.linear_angular,
        add_diagonal(m.linear, d.linear),
    )


def spatial_scale_rows_and_columns(rows: Spatial, m: Matrix6, columns: Spatial) -> Matrix6:
    """Return diag(rows) m diag(columns)."""
    return Matrix6(
        scale_rows_and_columns(rows.angular, m.angular, columns.angular),
        scale_rows_and_columns(rows.angular, m.angular_linear, columns.linear),
        scale_rows_and_columns(rows.linear, m.linear_angular, columns.angular),
        scale_rows_and_columns(rows.linear, m.linear, columns.linear),
    )


def matrix6_multiply(a: Matrix6, b: Matrix6) -> Matrix6:
    """Return a b."""
    return Matrix6(
        matrix_add(
            matrix_multiply(a.angular, b.angular),
            matrix_multiply(a.angular_linear, b.linear_angular),
        ),
        matrix_add(
            matrix_multiply(a.angular, b.angular_linear),
            matrix_multiply(a.angular_linear, b.linear),
        ),
        matrix_add(
            matrix_multiply(a.linear_angular, b.angular),
            matrix_multiply(a.linear, b.linear_angular),
        ),
        matrix_add(
            matrix_multiply(a.linear_angular, b.angular_linear),
            matrix_multiply(a.linear, b.linear),
        ),
    )


def matrix6_solve(m: Matrix6, a: Spatial) -> Spatial:
    """Return x with m x = a, by elimination of the linear part (Schur complement of m.linear).

    No pivoting between the blocks: meant for M + h D with M symmetric positive definite and D dissipative,
    whose diagonal blocks are regular. The linear block carries the masses, so it is the well-scaled one.
    """
    linear_inverse = invert(m.linear)
    gain = matrix_multiply(m.angular_linear, linear_inverse)
    schur = matrix_subtract(m.angular, matrix_multiply(gain, m.linear_angular))
    angular = transform(invert(schur), subtract(a.angular, transform(gain, a.linear)))
    linear = transform(linear_inverse, subtract(a.linear, transform(m.linear_angular, angular)))
    return Spatial(angular, linear)


def matrix6_invert(m: Matrix6) -> Matrix6:
    """Return the inverse of m by the same elimination: dearer than one solution, but the next ones are products."""
    linear_inverse = invert(m.linear)
    gain = matrix_multiply(m.angular_linear, linear_inverse)
    back = matrix_multiply(linear_inverse, m.linear_angular)
    angular = invert(matrix_subtract(m.angular, matrix_multiply(gain, m.linear_angular)))
    linear_angular = matrix_scale(-1.0, matrix_multiply(back, angular))
    return Matrix6(
        angular,
        matrix_scale(-1.0, matrix_multiply(angular, gain)),
        linear_angular,
        matrix_subtract(linear_inverse, matrix_multiply(linear_angular, gain)),
    )
