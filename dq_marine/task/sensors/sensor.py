"""What every sensor has: its errors as attributes, and the numbers that its instrument is given."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import ClassVar

from dq_marine.algebra.vector3 import Vector3
from dq_marine.checks import finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.task.sensors.errors import Instrument, SensorNumbers

MAY_BE_NEGATIVE = ("surface",)
"""Attributes that may be below zero."""


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """The errors that all sensors have, as standard deviations in the unit of the measured quantity.

    A kind of sensor is a frozen dataclass derived from it. It says with the class attribute `instrument` what it
    measures; with `shown` what bounds the numbers that its instrument shows; with attributes and `limits` what else the
    instrument needs to know. Environments take it by `sensors=[...]`, also from outside the package.

    Attributes:
        instrument: what is measured, as functions.
        shown: the largest magnitude of each number that joins the observation by itself.
        noise: error of each reading, independent of the others.
        bias: error that an episode begins with, the same in all of its readings.
        walk: change of the bias in one second, as a random walk: walk sqrt(t) in t seconds.
        scale: error of the gain, which is drawn about 1 for each episode.
        rate: readings in a second [Hz]; None for one in every control period, which is also the most there are.
        dropout: probability that a reading is lost.
    """

    instrument: ClassVar[Instrument]
    shown: ClassVar[tuple[float, ...]] = ()

    noise: float = 0.0
    bias: float = 0.0
    walk: float = 0.0
    scale: float = 0.0
    rate: float | None = None
    dropout: float = 0.0

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            InvalidInputError: a value is not finite, negative, or no probability.
        """
        for one in fields(self):
            label, value = f"sensors: {type(self).__name__}.{one.name}", getattr(self, one.name)
            if one.name == "rate":
                if value is not None:
                    object.__setattr__(self, one.name, finite_number(label, value, above=0.0))
                continue
            number = finite_number(label, value)
            if number < 0.0 and one.name not in MAY_BE_NEGATIVE:
                raise InvalidInputError(f"{label} = {number:g}; give 0 or more")
            object.__setattr__(self, one.name, number)
        if self.dropout > 1.0:
            raise InvalidInputError(f"sensors: {type(self).__name__}.dropout = {self.dropout:g}; give 0 to 1")

    def limits(self, gravity: float) -> tuple[float, float]:
        """Return the numbers that tell the instrument where it can measure, under a gravity [m/s^2]."""
        return (0.0, 0.0)

    def each(self, value: float, name: str) -> Vector3:
        """Return an error for each channel."""
        return (value, value, value)

    def numbers(self, period: float, gravity: float) -> SensorNumbers:
        """Return the numbers of the sensor for a control period [s] and a gravity [m/s^2]."""
        return SensorNumbers(
            noise=self.each(self.noise, "noise"),
            bias=self.each(self.bias, "bias"),
            walk=self.each(self.walk * math.sqrt(period), "walk"),
            scale=self.each(self.scale, "scale"),
            interval=period if self.rate is None else max(period, 1.0 / self.rate),
            period=period,
            dropout=float(self.dropout),
            limits=self.limits(gravity),
        )
