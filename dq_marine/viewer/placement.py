"""Where a thing stands in its parent frame: position, attitude and size, and the rotations they need."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dq_marine.viewer.snapshot import FloatArray

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

Y_AXIS: Vector3 = (0.0, 1.0, 0.0)
"""Bodies of revolution are built around it."""

UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)
"""The identity rotation, (w, x, y, z)."""

HIDDEN_SCALE = 1e-6
"""A thing drawn this small cannot be seen. Zero would make its matrix singular."""


@dataclass(frozen=True)
class Placement:
    """A similarity transform from a thing's own frame to that of its parent.

    Attributes:
        position: origin in the parent frame [m].
        quaternion: attitude (w, x, y, z), unit, own frame to parent frame.
        scale: one factor for all three axes, positive.
    """

    position: Vector3 = (0.0, 0.0, 0.0)
    quaternion: Quaternion = UPRIGHT
    scale: float = 1.0

    def rotation_matrix(self) -> FloatArray:
        """The attitude as a matrix, shape (3, 3): its columns are the own axes in the parent frame."""
        w, x, y, z = self.quaternion
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )

    def matrix_by_columns(self) -> list[float]:
        """The homogeneous 4 x 4 matrix as 16 numbers, column after column, as three.js stores it."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.scale * self.rotation_matrix()
        matrix[:3, 3] = self.position
        entries: list[float] = matrix.T.ravel().tolist()
        return entries


def hidden_at(position: Vector3) -> Placement:
    """For a thing that cannot be seen now, at the place where it may appear [m]."""
    return Placement(position, scale=HIDDEN_SCALE)


def vector3(values: Iterable[float]) -> Vector3:
    """Three floats of any sequence, such as a NumPy array, as a tuple."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def quaternion_wxyz(values: Iterable[float]) -> Quaternion:
    """Four floats of any sequence, such as a NumPy array, as a tuple."""
    w, x, y, z = (float(value) for value in values)
    return w, x, y, z


def length_of(vector: Iterable[float]) -> float:
    """Euclidean norm."""
    return math.hypot(*vector)


def rotation_between(start: Vector3, end: Vector3) -> Quaternion:
    """The shortest rotation that turns the direction of `start` into that of `end`.

    Args:
        start: any non-zero vector.
        end: any non-zero vector, in the same frame.

    Returns:
        A unit quaternion (w, x, y, z). For opposite vectors, half a turn about any normal.
    """
    ax, ay, az = _direction(start)
    bx, by, bz = _direction(end)
    # The half-way quaternion is (1 + a.b, a x b) before normalisation; it vanishes for b = -a.
    w = 1.0 + ax * bx + ay * by + az * bz
    if w < 1e-9:
        return (0.0, *_any_normal((ax, ay, az)))
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    norm = math.hypot(w, x, y, z)
    return w / norm, x / norm, y / norm, z / norm


def _direction(vector: Vector3) -> Vector3:
    norm = length_of(vector)
    return vector[0] / norm, vector[1] / norm, vector[2] / norm


def _any_normal(direction: Vector3) -> Vector3:
    """A unit vector normal to `direction`: its cross product with the axis it is least along."""
    x, y, z = direction
    if abs(x) <= min(abs(y), abs(z)):
        return _direction((0.0, z, -y))
    if abs(y) <= abs(z):
        return _direction((-z, 0.0, x))
    return _direction((y, -x, 0.0))


Y_TO_X: Quaternion = rotation_between(Y_AXIS, (1.0, 0.0, 0.0))
"""Lays a body of revolution along the vehicle, its upper end forward."""
