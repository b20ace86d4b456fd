"""Added mass of an ellipsoid in unbounded water (H. Lamb, Hydrodynamics, 6th ed., secs. 114 and 121)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_number

CARLSON_TOLERANCE = 1e-3
"""Largest relative spread at which Carlson's series is used; its error is of the sixth power."""


SMALLEST_AXIS, LARGEST_AXIS = 1e-6, 1e6
"""Semi-axes [m] of what is taken for an ellipsoid: far beyond, squares over- and underflow."""


def carlson_rd(x: float, y: float, z: float) -> float:
    """Return R_D(x, y, z) = (3/2) int_0^inf dt / sqrt((t + x)(t + y)(t + z)^3), for x, y >= 0 and z > 0.

    Carlson's duplication (B. C. Carlson 1995, Numerical Algorithms 10, 13, algorithm 4): accurate to round-off.
    """
    total, factor = 0.0, 1.0
    while True:
        mean = (x + y + 3.0 * z) / 5.0
        dx, dy, dz = ((mean - value) / mean for value in (x, y, z))
        if max(abs(dx), abs(dy), abs(dz)) < CARLSON_TOLERANCE:
            break
        roots = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        shift = roots[0] * roots[1] + roots[0] * roots[2] + roots[1] * roots[2]
        total += factor / (roots[2] * (z + shift))
        factor *= 0.25
        x, y, z = 0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift)
    e2 = dx * dy - 6.0 * dz * dz
    e3 = (3.0 * dx * dy - 8.0 * dz * dz) * dz
    e4 = 3.0 * (dx * dy - dz * dz) * dz * dz
    e5 = dx * dy * dz**3
    series = (
        1.0
        - 3.0 * e2 / 14.0
        + e3 / 6.0
        + 9.0 * e2 * e2 / 88.0
        - 3.0 * e4 / 22.0
        - 9.0 * e2 * e3 / 52.0
        + 3.0 * e5 / 26.0
    )
    return 3.0 * total + factor * series / (mean * math.sqrt(mean))


def added_mass_coefficients(a: float, b: float, c: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return an ellipsoid's added mass over its displaced mass, and added inertia over its displaced inertia.

    Args:
        a: semi-axis along x [m].
        b: along y [m].
        c: along z [m].

    Returns:
        k along and k' about x, y and z, each of shape (3,), dimensionless.

    Raises:
        InvalidInputError: a semi-axis is not above 0.
    """
    a, b, c = (
        finite_number(name, value, least=SMALLEST_AXIS, most=LARGEST_AXIS)
        for name, value in (("a", a), ("b", b), ("c", c))
    )
    squares = np.array([a, b, c]) ** 2
    alpha = np.array([_alpha(squares, i) for i in range(3)])
    along = alpha / (2.0 - alpha)  # sec. 114, eq. 11
    about = np.array([_about(squares, alpha, i) for i in range(3)])
    return along, about


def ellipsoid_mass_matrix(a: float, b: float, c: float, density: float = 1000.0) -> NDArray[np.float64]:
    """Return M = M_RB + M_A of a homogeneous, neutrally buoyant ellipsoid about its centre, shape (6, 6).

    Args:
        a: semi-axis along x [m].
        b: along y [m].
        c: along z [m].
        density: of body and water [kg/m^3].

    Raises:
        InvalidInputError: a value is not above 0.
    """
    added = ellipsoid_added_mass(a, b, c, density)
    mass = density * ellipsoid_volume(a, b, c)
    return np.diag(np.concatenate([[mass] * 3, mass * squared_gyration_radii(a, b, c)]) + added)


def ellipsoid_added_mass(a: float, b: float, c: float, density: float = 1000.0) -> NDArray[np.float64]:
    """Return the diagonal of an ellipsoid's M_A about its centre [kg, kg m^2], shape (6,).

    Args:
        a: semi-axis along x [m].
        b: along y [m].
        c: along z [m].
        density: of the water [kg/m^3].

    Raises:
        InvalidInputError: a value is not above 0.
    """
    along, about = added_mass_coefficients(a, b, c)
    displaced = finite_number("density", density, above=0.0) * ellipsoid_volume(a, b, c)
    return displaced * np.concatenate([along, about * squared_gyration_radii(a, b, c)])


def ellipsoid_volume(a: float, b: float, c: float) -> float:
    """Return the volume of an ellipsoid with these semi-axes [m^3]."""
    return 4.0 / 3.0 * math.pi * a * b * c


def squared_gyration_radii(a: float, b: float, c: float) -> NDArray[np.float64]:
    """Return a homogeneous ellipsoid's moments of inertia about its axes over its mass [m^2], shape (3,)."""
    return 0.2 * np.array([b * b + c * c, c * c + a * a, a * a + b * b])


def _alpha(squares: NDArray[np.float64], axis: int) -> float:
    """Return abc int_0^inf dt / ((a_i^2 + t) sqrt((a^2 + t)(b^2 + t)(c^2 + t))), sec. 114, eq. 6."""
    first, second = (float(squares[i]) for i in range(3) if i != axis)
    return 2.0 / 3.0 * math.sqrt(float(np.prod(squares))) * carlson_rd(first, second, float(squares[axis]))


def _about(squares: NDArray[np.float64], alpha: NDArray[np.float64], axis: int) -> float:
    """Return the coefficient of rotation about an axis, sec. 115, eq. 7; zero for a body of revolution about it."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    difference, total = squares[i] - squares[j], squares[i] + squares[j]
    if difference == 0.0:
        return 0.0
    gap = alpha[j] - alpha[i]
    return float(difference**2 * gap / (total * (2.0 * difference - total * gap)))
