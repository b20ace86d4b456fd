"""Turns what `weather=` takes into objects that make forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, asdict, fields
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import check_entries, one_of, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.term import ForceTerm
from dq_marine.physics.waves.loads import WaveLoads
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.slow_drift import SlowDrift
from dq_marine.physics.waves.spectra import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz
from dq_marine.physics.wind.build import Wind, Windage

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

SPECTRA = {
    "jonswap": (Jonswap, ("height", "period", "gamma")),
    "pierson_moskowitz": (PiersonMoskowitz, ("wind_speed",)),
    "modified_pierson_moskowitz": (ModifiedPiersonMoskowitz, ("height", "mean_period")),
}
"""Class and arguments of each spectrum, by its name in dictionaries."""


@runtime_checkable
class Weather(Protocol):
    """A sea, a wind or anything else that makes forces on a vehicle."""

    @property
    def changes(self) -> bool:
        """Whether it changes with time: episodes then begin at a time that is drawn."""

    def terms(self, vehicle: Vehicle, current_ned: NDArray[np.float64]) -> tuple[ForceTerm, ...]:
        """Return the forces on a vehicle in a current [m/s], shape (3,)."""


def weather_of(weather: Sequence[Any]) -> tuple[Weather, ...]:
    """Return objects that make forces, from what `weather=` was given.

    A `Sea` stands for its `WaveLoads`. A dictionary has a "kind" and the arguments of what it stands for:

        {"kind": "sea", "spectrum": "jonswap", "height": 1.0, "period": 6.0, "direction": 0.5}
        {"kind": "wind", "speed": 8.0, "direction_from": 3.0, "gusts": True}

    A sea's spectrum is one of `SPECTRA`, with its own arguments; with "slow_drift": True it has its slow drift, too. A
    wind's windage is a dictionary of `Windage`'s arguments.

    Raises:
        InvalidInputError: there is something else.
    """
    if not isinstance(weather, Sequence) or isinstance(weather, str):
        raise InvalidInputError(f"weather = {shown(weather)}; give a list, such as [Sea(...), Wind(...)]")
    return tuple(made for part in weather for made in _made(part))


def weather_terms(
    weather: Sequence[Weather], vehicle: Vehicle, current_ned: NDArray[np.float64]
) -> tuple[ForceTerm, ...]:
    """Return the forces of all weather on a vehicle in a current [m/s], shape (3,)."""
    return tuple(term for part in weather for term in part.terms(vehicle, current_ned))


def weather_of_hull(weather: Sequence[Weather], vehicle: Vehicle) -> tuple[Weather, ...]:
    """Return the weather with its forces as they are on a vehicle's hull, for others that are drawn from it.

    Weather of your own asks each vehicle itself.
    """
    known = WaveLoads | SlowDrift | Wind
    return tuple(part.of_hull(vehicle) if isinstance(part, known) else part for part in weather)


def _made(part: Any) -> tuple[Weather, ...]:
    if isinstance(part, Mapping):
        return _from_dictionary(dict(part))
    if isinstance(part, Sea):
        return (WaveLoads(part),)
    if isinstance(part, Weather):
        return (part,)
    raise InvalidInputError(
        f"weather has {shown(part)}; give Sea(...), WaveLoads(...), SlowDrift(...), Wind(...), or a dictionary with "
        "a kind"
    )


def _from_dictionary(arguments: dict[str, Any]) -> tuple[Weather, ...]:
    given = dict(arguments)
    kind = given.pop("kind", None)
    try:
        if kind == "wind":
            return (_wind(given),)
        if kind == "sea":
            slow_drift = given.pop("slow_drift", False)
            sea = _sea(given)
            return (WaveLoads(sea), SlowDrift(sea)) if slow_drift else (WaveLoads(sea),)
    except TypeError as error:
        raise InvalidInputError(f"weather has {shown(arguments)}: {error}") from error
    raise InvalidInputError(f"weather has {shown(arguments)} of kind {shown(kind)}; give 'sea' or 'wind'")


def _wind(given: dict[str, Any]) -> Wind:
    _check_names("a wind", given, Wind)
    windage = given.pop("windage", None)
    if isinstance(windage, Mapping):
        _check_names("a windage", windage, Windage)
        windage = Windage(**windage)
    return Wind(**given, windage=windage)


def _sea(given: dict[str, Any]) -> Sea:
    spectrum = one_of("spectrum", given.pop("spectrum", "jonswap"), SPECTRA)
    make, names = SPECTRA[spectrum]
    _check_names(f"a sea with the spectrum {spectrum!r}", {**given, "spectrum": spectrum}, Sea, make)
    own = {key: given.pop(key) for key in (*names, "gravity") if key in given}
    return Sea(make(**own), **given)


def _check_names(what: str, given: Mapping[str, Any], *classes: Any) -> None:
    """Refuse arguments that none of the classes takes, and a lack of those that they need."""
    known = [one for kind in classes for one in fields(kind)]
    needed = [one.name for one in known if one.default is MISSING]
    check_entries(f"weather: {what}", given, [one.name for one in known], needed)


def plain_weather(weather: Sequence[Any]) -> list[dict[str, Any]]:
    """Return weather as dictionaries of text and numbers, which `weather_of` takes.

    Raises:
        InvalidInputError: some of it is known by arrays, such as transfer functions, or is not of this package.
    """
    plain: list[dict[str, Any]] = []
    for part in weather_of(weather):
        if isinstance(part, Wind):
            plain.append({"kind": "wind", **asdict(part)})
        elif isinstance(part, WaveLoads) and not part.has_arrays:
            plain.append(_plain_sea(part.sea))
        elif (
            isinstance(part, SlowDrift) and part.coefficients is None and plain[-1:] == [_plain_sea(part.sea)]
        ):
            plain[-1]["slow_drift"] = True
        else:
            raise InvalidInputError(f"weather has {shown(part)}, which has no JSON; give it in Python")
    return plain


def _plain_sea(sea: Sea) -> dict[str, Any]:
    own = {one.name: getattr(sea, one.name) for one in fields(sea) if one.name != "spectrum"}
    names: dict[type[Any], str] = {kind: name for name, (kind, _) in SPECTRA.items()}
    spectrum = sea.spectrum
    if type(spectrum) not in names:
        raise InvalidInputError(f"weather has {shown(sea)}, whose spectrum has no JSON; give it in Python")
    return {"kind": "sea", "spectrum": names[type(spectrum)], **asdict(spectrum), **own}
