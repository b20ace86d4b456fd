"""The first-order forces of a sea on a vehicle, by the best that is known of it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.checks import shown
from dq_marine.errors import BeyondValidityWarning, InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.floating import Radiation, long_wave_rao, radiation_of
from dq_marine.physics.waves.rao import ForceRAO
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.submerged import submerged_terms

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle


@dataclass(frozen=True, eq=False)
class WaveLoads:
    """First-order forces of a sea: by transfer functions, else in the long-wave approximation.

    Attributes:
        sea: whose; under the gravity of the vehicle.
        rao: force transfer functions of the hull, where known.
        radiation: added mass and damping by frequency, for the long-wave approximation of a hull that floats; None for
            the vehicle's own.
        stiffness: hydrostatic, of heave, roll and pitch about the body origin, shape (3, 3) [N/m, N, N m]; None for the
            vehicle's own. A vehicle that has none is submerged.
    """

    sea: Sea
    rao: ForceRAO | None = None
    radiation: Radiation | None = None
    stiffness: ArrayLike | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be.

        Raises:
            InvalidInputError: with the reason.
        """
        if not isinstance(self.sea, Sea):
            raise InvalidInputError(f"sea = {shown(self.sea)}; give a dq_marine.physics.weather.Sea")
        if self.rao is not None and (self.radiation is not None or self.stiffness is not None):
            raise InvalidInputError(
                "rao and radiation or stiffness are given, but with transfer functions nothing else is asked; give one"
            )
        if self.stiffness is not None:
            _checked_stiffness(self.stiffness)

    def __eq__(self, other: object) -> bool:
        """Whether all is the same; transfer functions and radiation are, where they are one object."""
        if not isinstance(other, WaveLoads):
            return NotImplemented
        same = self.sea == other.sea and self.rao is other.rao and self.radiation is other.radiation
        return same and np.array_equal(np.asarray(self.stiffness), np.asarray(other.stiffness))

    def __hash__(self) -> int:
        """Follow equality."""
        return hash(self.sea)

    @property
    def has_arrays(self) -> bool:
        """Whether it is known by transfer functions or other arrays that were given for it."""
        return any(given is not None for given in (self.rao, self.radiation, self.stiffness))

    @property
    def changes(self) -> bool:
        """A sea does."""
        return True

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the forces on a vehicle in a current [m/s], shape (3,); the current takes no part."""
        sea = self.sea.in_gravity(vehicle.gravity)
        _warn_of_high_waves(sea, vehicle)
        rao = self._transfer_functions(sea, vehicle)
        return submerged_terms(sea, vehicle) if rao is None else (rao.term(sea),)

    def of_hull(self, vehicle: Vehicle) -> WaveLoads:
        """Return the loads of this sea on a vehicle's hull, for any other vehicle that has this hull.

        Transfer functions are those of a hull. A submerged vehicle has none: its loads stay those of its own numbers.
        """
        rao = self._transfer_functions(self.sea.in_gravity(vehicle.gravity), vehicle)
        return self if rao is None else WaveLoads(self.sea, rao)

    def _transfer_functions(self, sea: Sea, vehicle: Vehicle) -> ForceRAO | None:
        """Return what is given, else the long-wave approximation of a vehicle that floats."""
        if self.rao is not None:
            return self.rao
        own = vehicle.waterplane_stiffness if self.stiffness is None else _checked_stiffness(self.stiffness)
        if own is None:
            return None
        return long_wave_rao(sea, vehicle, own, self.radiation or radiation_of(vehicle))


def _warn_of_high_waves(sea: Sea, vehicle: Vehicle) -> None:
    validity, height = vehicle.validity, sea.spectrum.significant_height
    limit = None if validity is None else validity.wave_height
    if validity is not None and limit is not None and height > limit:
        source = validity.wave_height_source or validity.source
        warnings.warn(
            f"{vehicle.name} is in waves of {height:.3g} m; its numbers hold up to {limit:g} m ({source})",
            BeyondValidityWarning,
            stacklevel=2,
        )


def _checked_stiffness(stiffness: ArrayLike) -> NDArray[np.float64]:
    matrix = np.asarray(stiffness, dtype=np.float64)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all() or matrix[0, 0] <= 0.0:
        raise InvalidInputError(
            f"stiffness = {matrix.tolist()}; give 3 x 3 finite numbers, of heave, roll and pitch, the first positive"
        )
    return matrix
