"""What `weather=` takes, made into what makes forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.terms import ForceTerm
from dq_marine.vehicles import Vehicle
from dq_marine.weather.loads import WaveLoads
from dq_marine.weather.sea import Sea


@runtime_checkable
class Weather(Protocol):
    """What makes forces on a vehicle."""

    @property
    def changes(self) -> bool:
        """Whether it differs from one time to another: episodes then begin at a time that is drawn."""

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the forces on a vehicle in a current [m/s], shape (3,)."""


def weather_of(weather: Sequence[Any]) -> tuple[Weather, ...]:
    """Return what `weather=` was given as objects that make forces; a `Sea` stands for its `WaveLoads`.

    Raises:
        InvalidInputError: there is something else.
    """
    if not isinstance(weather, Sequence) or isinstance(weather, str):
        raise InvalidInputError(f"weather = {weather!r}; give a list, such as [Sea(...), Wind(...)]")
    return tuple(_one(part) for part in weather)


def _one(part: Any) -> Weather:
    if isinstance(part, Sea):
        return WaveLoads(part)
    if isinstance(part, Weather):
        return part
    raise InvalidInputError(
        f"weather has {part!r}; give Sea(...), WaveLoads(...), Wind(...) or a dictionary of one's arguments"
    )
