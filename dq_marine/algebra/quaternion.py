"""Quaternions as tuples (w, x, y, z), scalar first; unit quaternions rotate body to world."""

from __future__ import annotations

from typing import TypeAlias

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, scale

Quaternion: TypeAlias = tuple[float, float, float, float]


def quaternion_add(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3])


def quaternion_subtract(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3])


def quaternion_scale(s: float, a: Quaternion) -> Quaternion:
    """Return s a."""
    return (s * a[0], s * a[1], s * a[2], s * a[3])


def quaternion_dot(a: Quaternion, b: Quaternion) -> float:
    """Return the scalar product of a and b as vectors of R^4."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]


def quaternion_multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product a b."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def quaternion_conjugate(a: Quaternion) -> Quaternion:
    """Return the conjugate of a, which is the inverse of a unit quaternion."""
    return (a[0], -a[1], -a[2], -a[3])


def quaternion_from_vector(a: Vector3) -> Quaternion:
    """Return the pure quaternion (0, a)."""
    return (0.0, a[0], a[1], a[2])


def quaternion_vector(a: Quaternion) -> Vector3:
    """Return the vector part of a."""
    return (a[1], a[2], a[3])


def rotate(q: Quaternion, a: Vector3) -> Vector3:
    """Return q a q* for a unit q: a given in the body frame, returned in the world frame."""
    axis = (q[1], q[2], q[3])
    twice = scale(2.0, cross(axis, a))
    return add(add_scaled(a, q[0], twice), cross(axis, twice))


def rotate_inverse(q: Quaternion, a: Vector3) -> Vector3:
    """Return q* a q for a unit q: a given in the world frame, returned in the body frame."""
    return rotate(quaternion_conjugate(q), a)


def excess_of_length(q: Quaternion) -> float:
    """Return |q|^2 - 1 of a q that is nearly of unit length.

    It is summed around zero, not around one, where floating-point numbers lie closer together below than above: a
    million steps would show the bias.
    """
    return ((q[0] * q[0] - 1.0) + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3])


def quaternion_renormalise(q: Quaternion) -> Quaternion:
    """Return q with the round-off removed from its length.

    One Newton step of 1/sqrt towards |q| = 1: quadratic, so exact for an error of 1e-8.
    """
    return quaternion_add(q, quaternion_scale(-0.5 * excess_of_length(q), q))


def rotate_scaled(q: Quaternion, excess: float, a: Vector3) -> Vector3:
    """Return q a q*/|q|^2: a rotation by a q that is nearly of unit length, with |q|^2 - 1.

    The excess is taken from a product, not from 2, next to which numbers lie closer together below than above.
    """
    axis = (q[1], q[2], q[3])
    twice = scale(2.0, cross(axis, a))
    twice = add_scaled(twice, -excess, twice)
    return add(add_scaled(a, q[0], twice), cross(axis, twice))


def world_down_in_body(q: Quaternion) -> Vector3:
    """Return the world's z axis (down, in NED) in the body frame of the unit quaternion q."""
    return (
        2.0 * (q[1] * q[3] - q[0] * q[2]),
        2.0 * (q[2] * q[3] + q[0] * q[1]),
        1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]),
    )


def rotation_matrix(q: Quaternion) -> Matrix3:
    """Return the matrix R of a unit q, row-major: R a = q a q*, so its columns are the body axes in the world."""
    xx, yy, zz = q[1] * q[1], q[2] * q[2], q[3] * q[3]
    xy, xz, yz = q[1] * q[2], q[1] * q[3], q[2] * q[3]
    wx, wy, wz = q[0] * q[1], q[0] * q[2], q[0] * q[3]
    return (
        1.0 - 2.0 * (yy + zz),
        2.0 * (xy - wz),
        2.0 * (xz + wy),
        2.0 * (xy + wz),
        1.0 - 2.0 * (xx + zz),
        2.0 * (yz - wx),
        2.0 * (xz - wy),
        2.0 * (yz + wx),
        1.0 - 2.0 * (xx + yy),
    )
