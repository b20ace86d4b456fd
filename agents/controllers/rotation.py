"""Rotations as axis times angle: no singular attitude, and right at 180 degrees."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.vector3 import cross

Array = NDArray[np.float64]

SMALL_SINE = 1e-8
"""Half-angle sine below which the axis is not resolved and the angle is twice the sine."""


def quaternion_from_matrix(r: Array) -> Array:
    """Return the unit quaternion, scalar first and not negative, of a rotation matrix, shape (4,).

    The matrix gives 4 q q^T; its column with the largest diagonal entry is q up to a factor (Shepperd 1978,
    Quaternion from rotation matrix). Whatever the rotation, that column is at least 2 long.
    """
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    scalar, x, y, z = (
        1.0 + trace,
        1.0 - trace + 2 * r[0, 0],
        1.0 - trace + 2 * r[1, 1],
        1.0 - trace + 2 * r[2, 2],
    )
    sx, sy, sz = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    xy, xz, yz = r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1]
    columns = ((scalar, sx, sy, sz), (sx, x, xy, xz), (sy, xy, y, yz), (sz, xz, yz, z))
    largest = max(range(4), key=lambda i: columns[i][i])
    q = np.array(columns[largest])
    q /= math.copysign(math.sqrt(float(q @ q)), q[0])
    return q


def rotation_vector(r: Array) -> Array:
    """Return axis times angle [rad] of a rotation matrix, angle within [0, pi], shape (3,)."""
    q = quaternion_from_matrix(r)
    sine = math.sqrt(float(q[1:] @ q[1:]))
    if sine < SMALL_SINE:
        return 2.0 * q[1:]
    return 2.0 * math.atan2(sine, float(q[0])) / sine * q[1:]


def crossed(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the vector product a x b, shape (3,).

    It is asked for in every control period, and `numpy.cross`, made for stacks of vectors, takes ten times as long.
    """
    (a_x, a_y, a_z), (b_x, b_y, b_z) = np.asarray(a).tolist(), np.asarray(b).tolist()
    return np.array(cross((a_x, a_y, a_z), (b_x, b_y, b_z)))


def both_halves(r: Array, a: Array) -> Array:
    """Return linear and angular half of a 6-vector rotated, shape (6,)."""
    return np.concatenate([r @ a[:3], r @ a[3:]])
