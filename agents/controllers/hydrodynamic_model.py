"""What a controller knows of a vehicle in water: mass, Coriolis, damping and restoring, and their derivatives.

    M nu' = f(nu) + g(down) + tau,    f(nu) = [b x w; a x w + b x v] - (D + C(|nu|)) nu,                    (1)

with the momenta [b; a] = M nu (linear, angular), so that f has all Coriolis, centripetal and Munk terms, and C the
tensor of quadratic damping (Fossen 2021, Handbook of Marine Craft, ch. 6 and 8). Vectors are in Fossen's order. What
else acts on a vehicle, such as a current, strips of cross-flow or waves, is not in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

LEVI_CIVITA = np.array(
    [
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
        [[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ]
)
"""The cross product is a_j b_k times its entry ijk, summed."""

DOWN = np.array([0.0, 0.0, 1.0])
"""Down in a level body."""


def cross_matrix(vectors: Array) -> Array:
    """Return S with S b = a x b of vectors a of shape (..., 3), shape (..., 3, 3)."""
    matrices: Array = np.einsum("ijk,...j->...ik", LEVI_CIVITA, vectors)
    return matrices


class HydrodynamicModel:
    """Equation (1) for a vehicle under water.

    Attributes:
        mass_matrix: M with added mass, shape (6, 6).
        inverse_mass_matrix: its inverse.
        restoring_jacobian: derivative of g by a small rotation vector [rad] off the level, shape (6, 3).
    """

    def __init__(self, vehicle: Vehicle) -> None:
        """Take the vehicle's matrices."""
        self.mass_matrix = vehicle.mass_matrix
        self.inverse_mass_matrix = np.asarray(np.linalg.inv(self.mass_matrix), dtype=np.float64)
        self._linear = vehicle.linear_damping
        self._quadratic = vehicle.damping_couplings
        axes = np.arange(6)
        self._quadratic[axes, axes, axes] += vehicle.quadratic_damping
        self._signed = vehicle.signed_damping_couplings
        self._net_weight = vehicle.weight - vehicle.buoyant_force
        self._arm = vehicle.restoring_arm
        turned = cross_matrix(DOWN)  # down moves by -phi x down
        self.restoring_jacobian = np.vstack([self._net_weight * turned, cross_matrix(self._arm) @ turned])

    def wrench(self, velocity: Array) -> Array:
        """Return f of velocities [m/s, rad/s] of shape (..., 6), shape (..., 6) [N, N m]."""
        momentum = velocity @ self.mass_matrix
        b, a = momentum[..., :3], momentum[..., 3:]
        v, w = velocity[..., :3], velocity[..., 3:]
        inertial = np.concatenate([_cross(b, w), _cross(a, w) + _cross(b, v)], axis=-1)
        damping = velocity @ self._linear.T + _twice(self._quadratic, np.abs(velocity), velocity)
        total: Array = inertial - damping - _twice(self._signed, velocity, velocity)
        return total

    def jacobian(self, velocity: Array) -> Array:
        """Return the derivative of f by the velocity, at velocities of shape (..., 6), shape (..., 6, 6)."""
        momentum = velocity @ self.mass_matrix
        b, a = cross_matrix(momentum[..., :3]), cross_matrix(momentum[..., 3:])
        v, w = cross_matrix(velocity[..., :3]), cross_matrix(velocity[..., 3:])
        zero = np.zeros_like(b)
        turning = np.concatenate(
            [np.concatenate([w, zero], axis=-1), np.concatenate([v, w], axis=-1)], axis=-2
        )
        held = np.concatenate([np.concatenate([zero, b], axis=-1), np.concatenate([b, a], axis=-1)], axis=-2)
        speed, sign = np.abs(velocity), np.sign(velocity)
        drag = np.einsum("ijk,...k->...ij", self._quadratic, speed) + np.einsum(
            "ijk,...j,...k->...ik", self._quadratic, velocity, sign
        )
        lift = np.einsum("ijk,...k->...ij", self._signed, velocity) + np.einsum(
            "ijk,...j->...ik", self._signed, velocity
        )
        derivative: Array = held - turning @ self.mass_matrix - self._linear - drag - lift
        return derivative

    def restoring(self, down_body: Array) -> Array:
        """Return g of the direction of down, a unit vector of shape (3,): shape (6,) [N, N m]."""
        return np.concatenate([self._net_weight * down_body, _cross(self._arm, down_body)])


def _cross(a: Array, b: Array) -> Array:
    """Return a x b, shape (..., 3)."""
    product: Array = np.einsum("ijk,...j,...k->...i", LEVI_CIVITA, a, b)
    return product


def _twice(tensor: Array, speed: Array, velocity: Array) -> Any:
    """Return c_ijk speed_k velocity_j, summed."""
    return np.einsum("ijk,...k,...j->...i", tensor, speed, velocity)
