"""Converts vectors and matrices of NumPy, in Fossen's order, to the tuples of pure functions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.matrix3 import Matrix3
from dq_marine.algebra.spatial import ANGULAR_FIRST, Matrix6, Spatial, from_fossen
from dq_marine.algebra.vector3 import Vector3
from dq_marine.integrator.inertia import Inertia


def skew(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix S(a) with S(a) b = a x b, shape (3, 3)."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


Array = NDArray[np.float64]


def vector3(a: NDArray[Any]) -> Vector3:
    """Return an array of shape (3,) as a vector of pure functions."""
    x, y, z = a.tolist()
    return (x, y, z)


def spatial(a: Array) -> Spatial:
    """Return a vector of shape (6,) in Fossen's order as a spatial vector, angular first."""
    return from_fossen(a.tolist())


def angular_first(m: Array) -> Array:
    """Reorder a matrix of shape (6, 6) from Fossen's order to angular first; its own inverse."""
    return m[np.ix_(ANGULAR_FIRST, ANGULAR_FIRST)]


def matrix3(m: NDArray[Any]) -> Matrix3:
    """Return an array of shape (3, 3) as a matrix of pure functions."""
    a, b, c, d, e, f, g, h, i = m.ravel().tolist()
    return (a, b, c, d, e, f, g, h, i)


def matrix6(m: NDArray[Any]) -> Matrix6:
    """Return an angular-first array of shape (6, 6) in blocks."""
    return Matrix6(matrix3(m[:3, :3]), matrix3(m[:3, 3:]), matrix3(m[3:, :3]), matrix3(m[3:, 3:]))


def inertia_term(mass_matrix: Array) -> Inertia:
    """Return the inertia term of a symmetric positive definite M in Fossen's order, shape (6, 6)."""
    m = angular_first(mass_matrix)
    inverse = np.linalg.inv(m)
    return Inertia(matrix6(m), matrix6(0.5 * (inverse + inverse.T)), matrix3(np.linalg.inv(m[3:, 3:])))
