"""The forces of a sea on a vehicle, whatever kind of vehicle it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.terms import ForceTerm
from dq_marine.vehicles import Vehicle
from dq_marine.weather.sea import Sea
from dq_marine.weather.submerged import submerged_wave_term


@dataclass(frozen=True)
class WaveLoads:
    """First-order forces of a sea.

    Attributes:
        sea: whose.
    """

    sea: Sea

    @property
    def changes(self) -> bool:
        """Whether there is something to see at another time."""
        return True

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the forces on a vehicle in a current [m/s], shape (3,)."""
        return (submerged_wave_term(self.sea, vehicle),)
