"""Dual quaternions p = real + eps dual, eps^2 = 0; a pose is a unit one.

Pose of a body at position l (world) with attitude q: p = q + eps (1/2) l q  (Xu & Halse, eq. 24).
Unit means real . real = 1 and real . dual = 0.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.quaternion import (
    Quaternion,
    excess_of_length,
    quaternion_add,
    quaternion_conjugate,
    quaternion_dot,
    quaternion_from_vector,
    quaternion_multiply,
    quaternion_scale,
)
from dq_marine.algebra.vector3 import Vector3, scale


class DualQuaternion(NamedTuple):
    """A dual quaternion; both parts scalar first."""

    real: Quaternion
    dual: Quaternion


def dual_add(a: DualQuaternion, b: DualQuaternion) -> DualQuaternion:
    """Return a + b."""
    return DualQuaternion(quaternion_add(a.real, b.real), quaternion_add(a.dual, b.dual))


def dual_scale(s: float, a: DualQuaternion) -> DualQuaternion:
    """Return s a, s a real number. -p is the same pose as p."""
    return DualQuaternion(quaternion_scale(s, a.real), quaternion_scale(s, a.dual))


def dual_multiply(a: DualQuaternion, b: DualQuaternion) -> DualQuaternion:
    """Return the product a b."""
    return DualQuaternion(
        quaternion_multiply(a.real, b.real),
        quaternion_add(quaternion_multiply(a.real, b.dual), quaternion_multiply(a.dual, b.real)),
    )


def dual_conjugate(a: DualQuaternion) -> DualQuaternion:
    """Return the quaternion conjugate of both parts, the inverse of a unit dual quaternion."""
    return DualQuaternion(quaternion_conjugate(a.real), quaternion_conjugate(a.dual))


def dual_number_conjugate(a: DualQuaternion) -> DualQuaternion:
    """Return a with eps negated, real - eps dual, which keeps the order of products: (a b)' = a' b'."""
    return DualQuaternion(a.real, quaternion_scale(-1.0, a.dual))


def dual_combined_conjugate(a: DualQuaternion) -> DualQuaternion:
    """Return both conjugates at once, real* - eps dual*, which reverses products.

    It carries points: 1 + eps x goes to p (1 + eps x) p' (see `algebra.frames.point_to_world`). Twists and lines
    take `dual_conjugate` in the same place.
    """
    return DualQuaternion(quaternion_conjugate(a.real), quaternion_scale(-1.0, quaternion_conjugate(a.dual)))


def dual_transpose(a: DualQuaternion) -> DualQuaternion:
    """Return a with its parts swapped, dual + eps real: the a* of Xu & Halse."""
    return DualQuaternion(a.dual, a.real)


def dual_dot(a: DualQuaternion, b: DualQuaternion) -> float:
    """Return the scalar product of a and b as vectors of R^8: power, for a wrench and a twist.

    A factor of a product moves to the other side by two rules, with ` the conjugate of `dual_conjugate` and
    * the transpose of `dual_transpose`:

        a . (b c) = c* . (b` a*)          the left factor
        a . (b c) = b* . (a* c`)          the right factor
    """
    return quaternion_dot(a.real, b.real) + quaternion_dot(a.dual, b.dual)


def dual_inner(a: DualQuaternion, b: DualQuaternion) -> tuple[float, float]:
    """Return the scalar part of a` b, a dual number (real, dual), ` the conjugate of `dual_conjugate`.

    (1, 0) of a unit dual quaternion with itself, and unchanged when a and b are multiplied by one on the same
    side: of two poses it is the cosine of half the dual angle between them.
    """
    return (
        quaternion_dot(a.real, b.real),
        quaternion_dot(a.real, b.dual) + quaternion_dot(a.dual, b.real),
    )


def pose_from_parts(q: Quaternion, position: Vector3) -> DualQuaternion:
    """Return the pose of a body at `position` (world) with unit attitude q (body to world)."""
    return DualQuaternion(q, quaternion_scale(0.5, quaternion_multiply(quaternion_from_vector(position), q)))


def pose_position(pose: DualQuaternion) -> Vector3:
    """Return the position (world) of a unit dual quaternion: the vector part of 2 dual real*."""
    product = quaternion_multiply(pose.dual, quaternion_conjugate(pose.real))
    return scale(2.0, (product[1], product[2], product[3]))


def pose_translate(pose: DualQuaternion, displacement: Vector3) -> DualQuaternion:
    """Return the pose displaced by `displacement` in the world frame."""
    shift = quaternion_multiply(quaternion_from_vector(displacement), pose.real)
    return DualQuaternion(pose.real, quaternion_add(pose.dual, quaternion_scale(0.5, shift)))


def pose_renormalise(pose: DualQuaternion) -> DualQuaternion:
    """Return the pose with the round-off of one step removed from both unit constraints.

    One Newton step of 1/sqrt towards |real| = 1 (quadratic, so exact for an error of 1e-8), then the part of
    `dual` along `real` is dropped. Neither moves the position, 2 dual real*.
    """
    q = pose.real
    correction = -0.5 * excess_of_length(q)
    real = quaternion_add(q, quaternion_scale(correction, q))
    dual = quaternion_add(pose.dual, quaternion_scale(correction, pose.dual))
    along = quaternion_dot(real, dual)
    return DualQuaternion(real, quaternion_add(dual, quaternion_scale(-along, real)))
