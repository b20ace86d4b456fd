"""Natural motions of roll and pitch under weight and buoyancy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.vehicles.model import Vehicle

Array = NDArray[np.float64]


class RestoringModes(NamedTuple):
    """Undamped small motions about the stable attitude, upright or inverted, slower one first.

    Attributes:
        frequencies: angular frequencies [rad/s], shape (2,); zero without a righting moment.
        rotations: the direction in which each turns the body, unit, body axes, shape (2, 3).
    """

    frequencies: Array
    rotations: Array


def restoring_modes(vehicle: Vehicle) -> RestoringModes:
    """Return roll and pitch with the other axes free to follow, from the full M."""
    # Attitude change dphi turns "down" by -dphi x d, hence the moment -S(arm) S(d) dphi for d along the arm.
    arm = vehicle.restoring_arm
    length = float(np.linalg.norm(arm))
    if length == 0.0:
        return RestoringModes(np.zeros(2), np.eye(3)[:2])
    direction = arm / length
    stiffness = length * (np.eye(3) - np.outer(direction, direction))
    compliance = np.linalg.inv(vehicle.mass_matrix)[3:, 3:]
    squares, rotations = np.linalg.eig(compliance @ stiffness)
    order = np.argsort(squares.real)[1:]  # the first is zero: turning about the arm itself
    return RestoringModes(np.sqrt(np.maximum(squares.real[order], 0.0)), rotations.real.T[order])


def restoring_frequencies(vehicle: Vehicle) -> Array:
    """Return the angular frequencies of `restoring_modes` [rad/s], shape (2,)."""
    return restoring_modes(vehicle).frequencies


def natural_periods(vehicle: Vehicle) -> tuple[float, float]:
    """Return the undamped natural periods of roll and pitch [s], infinite without a righting moment.

    Of the two modes, roll is the one that turns more about x.
    """
    frequencies, rotations = restoring_modes(vehicle)
    if not frequencies.all():
        return (float("inf"), float("inf"))
    periods = [2.0 * np.pi / float(frequency) for frequency in frequencies]
    first, second = periods if abs(rotations[0, 0]) >= abs(rotations[1, 0]) else reversed(periods)
    return first, second
