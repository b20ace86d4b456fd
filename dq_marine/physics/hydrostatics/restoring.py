"""Natural motions under weight and buoyancy: roll and pitch of what is under water, and heave of what floats."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from dq_marine.vehicles.model import Vehicle


Array = NDArray[np.float64]

HEAVE, ROLL, PITCH = 2, 3, 4
"""Indices in Fossen's order."""


class RestoringModes(NamedTuple):
    """Undamped small motions about the stable attitude, slowest first.

    Attributes:
        frequencies: angular frequencies [rad/s], shape (n,): of roll and pitch, n = 2; with heave, n = 3, of a vessel
            that floats. Zero where nothing restores.
        motions: each as a velocity in Fossen's order, shape (n, 6).
    """

    frequencies: Array
    motions: Array


def restoring_modes(vehicle: Vehicle) -> RestoringModes:
    """Return the modes with the other axes free to follow, from the full M."""
    stiffness = vehicle.waterplane_stiffness
    return submerged_modes(vehicle) if stiffness is None else floating_modes(vehicle, stiffness)


def submerged_modes(vehicle: Vehicle) -> RestoringModes:
    """Return roll and pitch about the stable attitude, upright or inverted."""
    # Attitude change dphi turns "down" by -dphi x d, hence the moment -S(arm) S(d) dphi for d along the arm.
    arm = vehicle.restoring_arm + vehicle.payload_moment
    length = float(np.linalg.norm(arm))
    if length == 0.0:
        return RestoringModes(np.zeros(2), np.eye(6)[[ROLL, PITCH]])
    direction = arm / length
    stiffness = length * (np.eye(3) - np.outer(direction, direction))
    compliance = np.linalg.inv(vehicle.mass_matrix)[3:, 3:]
    squares, rotations = np.linalg.eig(compliance @ stiffness)
    order = np.argsort(squares.real)[1:]  # the first is zero: turning about the arm itself
    frequencies = np.sqrt(np.maximum(squares.real[order], 0.0))
    return RestoringModes(frequencies, np.hstack([np.zeros((2, 3)), rotations.real.T[order]]))


def floating_modes(vehicle: Vehicle, stiffness: Array) -> RestoringModes:
    """Return heave, roll and pitch for a stiffness about the body origin, shape (3, 3).

    The frequencies are zero where the stiffness does not right the vessel.
    """
    axes = [HEAVE, ROLL, PITCH]
    inverse = np.linalg.inv(vehicle.mass_matrix)
    squares, motions = np.linalg.eig(inverse[np.ix_(axes, axes)] @ stiffness)
    order = np.argsort(squares.real)
    frequencies = np.sqrt(np.maximum(squares.real[order], 0.0))
    # The accelerations of the other axes follow from the same force.
    return RestoringModes(frequencies, (inverse[:, axes] @ stiffness @ motions.real[:, order]).T)


def restoring_frequencies(vehicle: Vehicle) -> Array:
    """Return the angular frequencies of `restoring_modes` [rad/s], shape (2,), or (3,) of a vessel that floats."""
    return restoring_modes(vehicle).frequencies


def natural_periods(vehicle: Vehicle) -> tuple[float, float]:
    """Return the undamped natural periods of roll and pitch [s], infinite without a righting moment.

    If there are two modes, roll is the one that turns more about x; for three, see `floating_periods`.
    """
    if vehicle.hydrostatics is not None:
        return floating_periods(vehicle)[1:]
    frequencies, motions = restoring_modes(vehicle)
    if not frequencies.all():
        return (float("inf"), float("inf"))
    periods = [2.0 * np.pi / float(frequency) for frequency in frequencies]
    first, second = periods if abs(motions[0, ROLL]) >= abs(motions[1, ROLL]) else reversed(periods)
    return first, second


def heave_period(vehicle: Vehicle) -> float:
    """Return the undamped natural period of heave [s], infinite for a vehicle that does not float."""
    return float("inf") if vehicle.hydrostatics is None else floating_periods(vehicle)[0]


def floating_periods(vehicle: Vehicle) -> tuple[float, float, float]:
    """Return the undamped natural periods of heave, roll and pitch [s] of a vessel that floats.

    Each mode is named after one of the three: so that the energies M_ii v_i^2 in those axes are largest together.
    """
    frequencies, motions = restoring_modes(vehicle)
    energies = motions**2 * np.diag(vehicle.mass_matrix)
    shares = energies[:, [HEAVE, ROLL, PITCH]] / energies.sum(axis=1, keepdims=True)
    modes = max(permutations(range(3)), key=lambda order: sum(shares[order, range(3)]))
    heave, roll, pitch = (2.0 * np.pi / float(frequencies[mode]) for mode in modes)
    return heave, roll, pitch
