"""The weather as a person sets it: sliders of one sea and one wind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from dq_marine.physics.waves.loads import WaveLoads
from dq_marine.physics.weather.choice import SPECTRA, plain_weather, weather_of
from dq_marine.viewer.controls import Event, Slider

SEA = ("sea_height", "sea_period", "sea_direction")
WIND = ("wind_speed", "wind_direction")
"""Names of the sliders."""

HIGHEST_SEA, SHORTEST_PERIOD, LONGEST_PERIOD = 10.0, 2.0, 20.0
STRONGEST_WIND = 30.0
"""That the sliders go to [m], [s] and [m/s]; a given weather beyond them moves their ends."""

USUAL_PERIOD = 8.0
"""Of the peak of a sea that is not there yet [s]."""

JONSWAP = "jonswap"


class WeatherDials:
    """Significant height, peak period and direction of the first sea, speed and direction of the first wind.

    What is not on a slider, such as gusts, a spreading or a second sea, stays as it was given. A sea of another
    spectrum becomes a Jonswap of the same height and period once one of its sliders is moved.
    """

    def __init__(self, weather: Sequence[Any]) -> None:
        """Set the sliders to a weather, as `dq_marine.physics.weather.weather_of` takes it.

        Raises:
            InvalidInputError: it is none, or known by arrays, such as transfer functions.
        """
        plain = plain_weather(weather)
        self._sea = next((part for part in plain if part["kind"] == "sea"), None)
        self._wind = next((part for part in plain if part["kind"] == "wind"), None)
        self._others = [part for part in plain if part is not self._sea and part is not self._wind]
        self._values = {**_sea_values(self._sea), **_wind_values(self._wind)}
        self._moved: set[str] = set()

    def controls(self) -> tuple[Slider, ...]:
        """Return the sliders, as they stand; a sea of no height and a wind of no speed are left out of the weather."""
        return (
            self._slider(SEA[0], "significant height", 0.0, HIGHEST_SEA, 0.05, "m"),
            self._slider(SEA[1], "peak period", SHORTEST_PERIOD, LONGEST_PERIOD, 0.1, "s"),
            self._slider(SEA[2], "waves go to", 0.0, 360.0, 1.0, "deg"),
            self._slider(WIND[0], "wind at 10 m", 0.0, STRONGEST_WIND, 0.1, "m/s"),
            self._slider(WIND[1], "wind comes from", 0.0, 360.0, 1.0, "deg"),
        )

    def take(self, event: Event) -> bool:
        """Move a slider, if an event is of one of them; return whether it is."""
        if event.name not in self._values:
            return False
        self._values[event.name] = event.value
        self._moved.add(event.name)
        return True

    def weather(self) -> list[dict[str, Any]]:
        """Return the weather as dictionaries of text and numbers."""
        parts = (self._changed_sea(), self._changed_wind())
        return [part for part in parts if part is not None] + self._others

    def _slider(self, name: str, label: str, least: float, most: float, step: float, unit: str) -> Slider:
        value = self._values[name]
        return Slider(name, label, min(least, value), max(most, value), value, step, unit)

    def _changed_sea(self) -> dict[str, Any] | None:
        if not self._moved.intersection(SEA):
            return self._sea
        height, period, direction = (self._values[name] for name in SEA)
        if height == 0.0:
            return None
        kept = dict(self._sea or {"kind": "sea"})
        spectrum = kept.get("spectrum", JONSWAP)
        if spectrum != JONSWAP:
            kept = {name: value for name, value in kept.items() if name not in SPECTRA[spectrum][1]}
        named = {"spectrum": JONSWAP, "height": height, "period": period}
        return {**kept, **named, "direction": math.radians(direction)}

    def _changed_wind(self) -> dict[str, Any] | None:
        if not self._moved.intersection(WIND):
            return self._wind
        speed, direction = (self._values[name] for name in WIND)
        if speed == 0.0:
            return None
        kept = self._wind or {"kind": "wind"}
        return {**kept, "speed": speed, "direction_from": math.radians(direction)}


def _sea_values(sea: dict[str, Any] | None) -> dict[str, float]:
    if sea is None:
        return dict(zip(SEA, (0.0, USUAL_PERIOD, 0.0), strict=True))
    loads = next(part for part in weather_of([sea]) if isinstance(part, WaveLoads))
    spectrum = loads.sea.spectrum
    values = (spectrum.significant_height, spectrum.peak_period, _degrees(loads.sea.direction))
    return dict(zip(SEA, values, strict=True))


def _wind_values(wind: dict[str, Any] | None) -> dict[str, float]:
    values = (0.0, 0.0) if wind is None else (wind["speed"], _degrees(wind["direction_from"]))
    return dict(zip(WIND, values, strict=True))


def _degrees(angle: float) -> float:
    return math.degrees(angle) % 360.0
