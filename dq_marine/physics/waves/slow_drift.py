"""Mean and slowly varying force of waves: drift coefficients, and the slow drift force."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.floating import draft_of
from dq_marine.physics.waves.formulas.slow_drift import DriftRoots, WaveDrift, wave_drift
from dq_marine.physics.waves.sea import Sea, table
from dq_marine.physics.waves.tables import check_rising, check_table

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DriftCoefficients:
    """Mean drift per squared wave amplitude, by frequency.

    With beta the direction of the waves relative to the heading, the mean push of a regular wave of amplitude a is
    a^2 (X cos(beta)|cos(beta)|, Y sin(beta)|sin(beta)|, N sin(2 beta)).

    Attributes:
        frequencies: rising, shape (n,) [rad/s].
        coefficients: X, Y and N, shape (n, 3) [N/m^2, N/m^2, N/m]. Linear between the frequencies, held beyond.
    """

    frequencies: Array
    coefficients: Array

    def __post_init__(self) -> None:
        """Refuse what does not fit together.

        Raises:
            InvalidInputError: with the reason.
        """
        check_rising("frequencies", self.frequencies)
        check_table("coefficients", self.coefficients, (len(self.frequencies), 3))

    def at(self, frequencies: Array) -> Array:
        """Return the coefficients at frequencies [rad/s], shape (len(frequencies), 3)."""
        columns = self.coefficients.T
        return np.stack([np.interp(frequencies, self.frequencies, column) for column in columns], axis=1)


def reflected_drift(
    frequencies: Array, wave_numbers: Array, vehicle: Vehicle, draft: float
) -> DriftCoefficients:
    """Return coefficients of a wall-sided hull that stands still, by the share of the waves that it throws back.

    Of waves that are thrown back with R times their amplitude, a wall of length L feels 1/2 rho g a^2 R^2 L (Maruo
    1960): in short waves, R = 1, which is the most there can be. Here R^2 = 1 - e^{-2 k T}, the share of the energy
    that deep-water waves carry above the draft T. A hull that goes with the waves throws back less, but near its
    resonances; use coefficients of a panel program where there are any. There is none in yaw.

    Args:
        frequencies: [rad/s], rising.
        wave_numbers: k at these [rad/m].
        vehicle: whose length and width.
        draft: T [m].
    """
    pressure = 0.5 * vehicle.specific_weight * -np.expm1(-2.0 * wave_numbers * draft)
    size = vehicle.dimensions
    walls = np.array([size.width, size.length, 0.0])
    return DriftCoefficients(frequencies, pressure[:, None] * walls)


def estimated_drift(sea: Sea, vehicle: Vehicle) -> DriftCoefficients:
    """Return coefficients at a sea's frequencies: those of `reflected_drift`, with the vehicle's mean draft.

    Raises:
        InvalidInputError: the vehicle is submerged.
    """
    stiffness = vehicle.waterplane_stiffness
    if stiffness is None:
        raise InvalidInputError(
            f"{vehicle.name} is submerged, and its drift cannot be estimated; give SlowDrift(sea, coefficients)"
        )
    return reflected_drift(sea.frequencies, sea.wave_numbers, vehicle, draft_of(vehicle, stiffness))


@dataclass(frozen=True)
class SlowDrift:
    """The mean and slowly varying second-order force of a sea.

    Waves of all directions push into the sea's mean one.

    Attributes:
        sea: whose; under the gravity of the vehicle.
        coefficients: of the hull; None for those of `estimated_drift`.
    """

    sea: Sea
    coefficients: DriftCoefficients | None = None

    @property
    def changes(self) -> bool:
        """It does."""
        return True

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the force on a vehicle in a current [m/s], shape (3,); the current takes no part.

        Raises:
            InvalidInputError: the vehicle is submerged, and no coefficients were given.
        """
        sea = self.sea.in_gravity(vehicle.gravity)
        coefficients = self._coefficients(sea, vehicle)
        values = coefficients.at(sea.frequencies)
        roots = sea.amplitudes[:, None] * np.sqrt(np.abs(values))
        surge, sway, yaw = (
            DriftRoots(table(root), table(np.sign(value) * root))
            for root, value in zip(roots.T, values.T, strict=True)
        )
        direction = sea.direction
        parameters = WaveDrift(sea.field, math.cos(direction), math.sin(direction), surge, sway, yaw)
        return (ForceTerm("slow drift", wave_drift, parameters),)

    def of_hull(self, vehicle: Vehicle) -> SlowDrift:
        """Return the force of this sea on a vehicle's hull, for any other vehicle that has this hull.

        Raises:
            InvalidInputError: the vehicle is submerged, and no coefficients were given.
        """
        return SlowDrift(self.sea, self._coefficients(self.sea.in_gravity(vehicle.gravity), vehicle))

    def _coefficients(self, sea: Sea, vehicle: Vehicle) -> DriftCoefficients:
        return self.coefficients or estimated_drift(sea, vehicle)
