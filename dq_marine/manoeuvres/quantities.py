"""Results of a manoeuvre: numbers with their names and units, and the base class of all results."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from dq_marine.manoeuvres.series import Series


@dataclass(frozen=True)
class Quantity:
    """A number that a manoeuvre was run for.

    Attributes:
        key: its name in JSON, the unit at its end.
        label: its name for people.
        value: in that unit; None where the run did not get there.
        unit: for people.
        limit: the most that the IMO's Standards for Ship Manoeuvrability, Resolution MSC.137(76), allow for ships of
            100 m and more, in that unit; None where they say nothing.
    """

    key: str
    label: str
    value: float | None
    unit: str
    limit: float | None = None


@dataclass(frozen=True, kw_only=True)
class Result:
    """The base class of the results that manoeuvres return.

    Attributes:
        manoeuvre: its name.
        vehicle: the vehicle's name.
        length: of the vehicle [m].
        width: of the vehicle [m].
        settings: what was asked for, by name.
        step: of the integrator [s].
        series: what happened; time 0 is where the manoeuvre begins.
        notes: what a reader of the numbers should know.
    """

    manoeuvre: ClassVar[str]

    vehicle: str
    length: float
    width: float
    settings: dict[str, float | str]
    step: float
    series: Series
    notes: tuple[str, ...] = ()

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        raise NotImplementedError

    def as_dict(self) -> dict[str, Any]:
        """Return all but the series, as JSON has it; what was not reached is None."""
        return {
            "manoeuvre": self.manoeuvre,
            "vehicle": self.vehicle,
            "settings": {**self.settings, "step_s": self.step},
            "quantities": {quantity.key: quantity.value for quantity in self.quantities()},
            "imo_limits": {
                quantity.key: quantity.limit for quantity in self.quantities() if quantity.limit is not None
            },
            "notes": list(self.notes),
        }


def degrees(angle: float | None) -> float | None:
    """Return an angle in degrees; None of None."""
    return None if angle is None else math.degrees(angle)


def over(value: float | None, unit: float) -> float | None:
    """Return a value in multiples of a unit; None of None."""
    return None if value is None else value / unit
