"""Small free motions about upright rest, by the linear equations M nu' + D nu + G eta = 0."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.matrices import skew
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

DOWN = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class LinearMode:
    """A damped oscillation.

    Attributes:
        period: damped, from peak to peak of the same side [s].
        natural_frequency: undamped, omega_n [rad/s].
        damping_ratio: zeta.
    """

    period: float
    natural_frequency: float
    damping_ratio: float


def stiffness_matrix(vehicle: Vehicle) -> Array:
    """Return G, upright: restoring wrench -G eta of small motions, Fossen's order, shape (6, 6).

    Of a vessel that floats, its waterplane's and its payloads'. Under water, a small turn dphi moves "down" by d x dphi
    in the body frame, and with it the righting moment arm x d.
    """
    matrix = np.zeros((6, 6))
    waterplane, arm = vehicle.waterplane_stiffness, vehicle.payload_moment
    if waterplane is None:
        arm = arm + vehicle.restoring_arm
    else:
        matrix[2:5, 2:5] = waterplane
    matrix[3:, 3:] -= skew(arm) @ skew(DOWN)
    return matrix


def rest_of(vehicle: Vehicle) -> Array:
    """Return heave [m], roll and pitch [rad] at rest, shape (3,): what payloads do to a vessel that floats."""
    if vehicle.hydrostatics is None:
        return np.zeros(3)
    x, y, _ = vehicle.payload_moment
    return np.linalg.solve(stiffness_matrix(vehicle)[2:5, 2:5], np.array([vehicle.payload_weight, y, -x]))


def linear_mode(vehicle: Vehicle, axis: int) -> LinearMode | None:
    """Return the oscillation in which an axis takes most part, the others free to follow; None if none oscillates.

    Args:
        vehicle: M, its linear damping D at rest and G are used.
        axis: 2 heave, 3 roll, 4 pitch.
    """
    inverse = np.linalg.inv(vehicle.mass_matrix)
    system = np.block(
        [
            [np.zeros((6, 6)), np.eye(6)],
            [-inverse @ stiffness_matrix(vehicle), -inverse @ vehicle.damping_at_rest],
        ]
    )
    rates, shapes = np.linalg.eig(system)
    oscillating = np.flatnonzero(rates.imag > 1e-9 * np.abs(rates).max())
    if not oscillating.size:
        return None
    scale = np.sqrt(np.diag(vehicle.mass_matrix))[:, None]
    parts = np.abs(shapes[:6, oscillating]) * scale
    chosen = rates[oscillating[int((parts[axis] / np.linalg.norm(parts, axis=0)).argmax())]]
    frequency = float(abs(chosen))
    return LinearMode(2.0 * math.pi / float(chosen.imag), frequency, 0.0 - float(chosen.real) / frequency)
