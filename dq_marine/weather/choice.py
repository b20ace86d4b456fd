"""What `weather=` takes, made into what makes forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.terms import ForceTerm
from dq_marine.vehicles import Vehicle
from dq_marine.weather.drift import SlowDrift
from dq_marine.weather.loads import WaveLoads
from dq_marine.weather.sea import Sea
from dq_marine.weather.spectra import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz
from dq_marine.weather.wind import Wind, Windage

SPECTRA = {
    "jonswap": (Jonswap, ("height", "period", "gamma")),
    "pierson_moskowitz": (PiersonMoskowitz, ("wind_speed",)),
    "modified_pierson_moskowitz": (ModifiedPiersonMoskowitz, ("height", "mean_period")),
}
"""By the names that dictionaries have for them: the class, and its arguments."""


@runtime_checkable
class Weather(Protocol):
    """What makes forces on a vehicle."""

    @property
    def changes(self) -> bool:
        """Whether it differs from one time to another: episodes then begin at a time that is drawn."""

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the forces on a vehicle in a current [m/s], shape (3,)."""


def weather_of(weather: Sequence[Any]) -> tuple[Weather, ...]:
    """Return what `weather=` was given as objects that make forces.

    A `Sea` stands for its `WaveLoads`. A dictionary has a "kind" and the arguments of what it stands for:

        {"kind": "sea", "spectrum": "jonswap", "height": 1.0, "period": 6.0, "direction": 0.5}
        {"kind": "wind", "speed": 8.0, "direction_from": 3.0, "gusts": True}

    A sea's spectrum is one of `SPECTRA`, with its own arguments; with "drift": True it has its slow drift, too. A
    wind's windage is a dictionary of `Windage`'s arguments.

    Raises:
        InvalidInputError: there is something else.
    """
    if not isinstance(weather, Sequence) or isinstance(weather, str):
        raise InvalidInputError(f"weather = {weather!r}; give a list, such as [Sea(...), Wind(...)]")
    return tuple(made for part in weather for made in _made(part))


def weather_terms(
    weather: Sequence[Weather], vehicle: Vehicle, current_ned: NDArray[np.float64]
) -> tuple[ForceTerm, ...]:
    """Return the forces of all weather on a vehicle in a current [m/s], shape (3,)."""
    return tuple(term for part in weather for term in part.terms(vehicle, current_ned))


def _made(part: Any) -> tuple[Weather, ...]:
    if isinstance(part, Mapping):
        return _from_dictionary(dict(part))
    if isinstance(part, Sea):
        return (WaveLoads(part),)
    if isinstance(part, Weather):
        return (part,)
    raise InvalidInputError(
        f"weather has {part!r}; give Sea(...), WaveLoads(...), SlowDrift(...), Wind(...), or a dictionary with a kind"
    )


def _from_dictionary(arguments: dict[str, Any]) -> tuple[Weather, ...]:
    given = dict(arguments)
    kind = given.pop("kind", None)
    try:
        if kind == "wind":
            windage = given.pop("windage", None)
            hold = Windage(**windage) if isinstance(windage, Mapping) else windage
            return (Wind(**given, windage=hold),)
        if kind == "sea":
            drift = given.pop("drift", False)
            sea = _sea(given)
            return (WaveLoads(sea), SlowDrift(sea)) if drift else (WaveLoads(sea),)
    except TypeError as error:
        raise InvalidInputError(f"weather has {arguments!r}: {error}") from error
    raise InvalidInputError(f"weather has {arguments!r} of kind {kind!r}; give 'sea' or 'wind'")


def _sea(given: dict[str, Any]) -> Sea:
    name = given.pop("spectrum", "jonswap")
    if name not in SPECTRA:
        raise InvalidInputError(f"spectrum = {name!r} is unknown; give one of {list(SPECTRA)}")
    make, names = SPECTRA[name]
    return Sea(make(**{key: given.pop(key) for key in names if key in given}), **given)
