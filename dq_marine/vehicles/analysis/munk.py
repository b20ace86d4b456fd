"""The Munk instability: the rate at which a body that moves straight ahead turns away from its course."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_number
from dq_marine.physics.matrices import skew
from dq_marine.vehicles.model import Vehicle

NOISE = 1e-6
"""Growth over the largest entry of the linear system, below which it is round-off of a multiple eigenvalue 0."""


def munk_growth_rate(vehicle: Vehicle, speed: float = 1.0) -> float:
    """Return the growth rate [1/s] of small deviations from steady motion along x, zero if none grows.

    Of Kirchhoff's equations (Lamb, Hydrodynamics, 6th ed., sec. 124) without damping and righting moment, with the
    constant wrench that holds the steady motion where M is coupled. For a body with three planes of symmetry it is

        sigma = U sqrt(m1 (m - m1)/(m J))                                                                  (1)

    for the pair (m, J) = (m3, J2) or (m2, J3) in which it is larger. It is proportional to U.

    Args:
        vehicle: its mass matrix alone is used.
        speed: U, through the water [m/s].

    Raises:
        InvalidInputError: the speed is not finite and above 0.
    """
    speed = finite_number("speed", speed, above=0.0)
    system = _deviations_from_ahead(vehicle.mass_matrix)
    rate = float(np.linalg.eigvals(system).real.max())
    if rate <= NOISE * float(np.abs(system).max()):
        return 0.0
    return rate * speed


def _deviations_from_ahead(mass_matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return A of d(dnu)/dt = A dnu about nu = (1, 0, 0, 0, 0, 0).

    From dp/dt = p x omega and dpi/dt = pi x omega + p x v, with p and pi the linear and angular rows of M nu.
    """
    ahead = np.array([1.0, 0.0, 0.0])
    linear, angular = mass_matrix[:3, :3] @ ahead, mass_matrix[3:, :3] @ ahead
    change = np.zeros((6, 6))
    change[:3, 3:] = skew(linear)
    change[3:, :3] = skew(linear) - skew(ahead) @ mass_matrix[:3, :3]
    change[3:, 3:] = skew(angular) - skew(ahead) @ mass_matrix[:3, 3:]
    return np.asarray(np.linalg.solve(mass_matrix, change))
