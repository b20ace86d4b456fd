"""Sensors that an environment's agent is told by, with their errors, rates and drop-outs.

An agent without sensors knows its motion as it is. With them, each sensor stands for a part of the motion:

    Gyroscope        angular velocity
    DopplerLog       velocity over ground
    DepthMeter       depth
    Compass          attitude: heading, and tilt
    SatelliteFix     north and east position, near the surface only
    Accelerometer    specific force, which joins the observation by itself

What no sensor stands for is told as it is: under water that is the horizontal position, as if from an acoustic
positioning system without errors; there is no dead reckoning. A sensor tells its last reading until the next, and how
old that is: every sensor adds its reading's age to the observation. An episode starts with a reading of each. Rewards,
measures and ends of episodes follow from the true motion.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, TypeAlias

from dq_marine.checks import finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.instruments import (
    ACCELEROMETER,
    COMPASS,
    DEPTH_METER,
    DOPPLER_LOG,
    GYROSCOPE,
    MOST_FORCE,
    SATELLITE_RECEIVER,
)
from dq_marine.kernel.sensing import OLDEST
from dq_marine.kernel.sensors import Instrument, SensorNumbers
from dq_marine.kernel.vector3 import Vector3
from dq_marine.vehicles.model import STANDARD_GRAVITY

MAY_BE_NEGATIVE = ("surface",)
"""Attributes that may be below zero."""


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """What all sensors have. Errors are standard deviations, in the unit of what is measured.

    Attributes:
        noise: of each reading, independent of the others.
        bias: of the error that an episode begins with.
        walk: of what the bias gains in a second, as a random walk: in t seconds walk sqrt(t).
        scale: of the gain, about 1, that an episode has.
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
        """Refuse what no sensor has.

        Raises:
            InvalidInputError: a value is not finite, negative, or no probability.
        """
        for one in fields(self):
            label, value = f"sensors: {type(self).__name__}.{one.name}", getattr(self, one.name)
            if one.name == "rate":
                if value is not None:
                    finite_number(label, value, above=0.0)
                continue
            number = finite_number(label, value)
            if number < 0.0 and one.name not in MAY_BE_NEGATIVE:
                raise InvalidInputError(f"{label} = {number:g}; give 0 or more")
        if self.dropout > 1.0:
            raise InvalidInputError(f"sensors: {type(self).__name__}.dropout = {self.dropout:g}; give 0 to 1")

    @property
    def limits(self) -> tuple[float, float]:
        """What the instrument needs to know of where it can measure."""
        return (0.0, 0.0)

    def each(self, value: float, name: str) -> Vector3:
        """Return an error for each channel."""
        return (value, value, value)

    def numbers(self, period: float) -> SensorNumbers:
        """Return the sensor as the kernel has it, for a control period [s]."""
        return SensorNumbers(
            noise=self.each(self.noise, "noise"),
            bias=self.each(self.bias, "bias"),
            walk=self.each(self.walk * math.sqrt(period), "walk"),
            scale=self.each(self.scale, "scale"),
            interval=period if self.rate is None else max(period, 1.0 / self.rate),
            period=period,
            dropout=float(self.dropout),
            limits=self.limits,
        )


@dataclass(frozen=True, kw_only=True)
class Gyroscope(Sensor):
    """Angular velocity in the body frame [rad/s]."""

    instrument = GYROSCOPE


@dataclass(frozen=True, kw_only=True)
class Accelerometer(Sensor):
    """Specific force at the body origin in the body frame [m/s^2]: the mean over the last control period.

    Three numbers more to observe, held within 200 m/s^2. At an episode's start it reads as if at constant velocity.
    """

    instrument = ACCELEROMETER
    shown = (MOST_FORCE,) * 3

    @property
    def limits(self) -> tuple[float, float]:
        """The acceleration of gravity [m/s^2]."""
        return (STANDARD_GRAVITY, 0.0)


@dataclass(frozen=True, kw_only=True)
class DopplerLog(Sensor):
    """A Doppler velocity log with bottom lock: velocity over ground in the body frame [m/s].

    Attributes:
        seabed: depth of the sea bed [m].
        reach: altitude above it up to which there is a reading [m].
    """

    instrument = DOPPLER_LOG
    seabed: float = 100.0
    reach: float = 200.0

    @property
    def limits(self) -> tuple[float, float]:
        """Depth of the sea bed, and the largest altitude [m]."""
        return (self.seabed, self.reach)


@dataclass(frozen=True, kw_only=True)
class DepthMeter(Sensor):
    """Depth from the pressure [m]."""

    instrument = DEPTH_METER


@dataclass(frozen=True, kw_only=True)
class SatelliteFix(Sensor):
    """North and east position from satellites [m], while the vehicle is near the surface.

    Attributes:
        surface: largest depth of the body origin at which there is a fix [m].
    """

    instrument = SATELLITE_RECEIVER
    rate: float | None = 1.0
    surface: float = 0.5

    @property
    def limits(self) -> tuple[float, float]:
        """Largest depth with a fix [m]."""
        return (self.surface, 0.0)


@dataclass(frozen=True, kw_only=True)
class Compass(Sensor):
    """Heading and tilt [rad].

    Attributes:
        tilt: all errors of roll and pitch, over those of the heading.
    """

    instrument = COMPASS
    tilt: float = 0.1

    def each(self, value: float, name: str) -> Vector3:
        """Return errors about north, east and down."""
        return (self.tilt * value, self.tilt * value, value)


KINDS: dict[str, type[Sensor]] = {
    "gyroscope": Gyroscope,
    "accelerometer": Accelerometer,
    "doppler_log": DopplerLog,
    "depth_meter": DepthMeter,
    "satellite_fix": SatelliteFix,
    "compass": Compass,
}
"""Kinds of sensors by name, in the order in which a dictionary of them is taken."""

AUV = (
    Gyroscope(noise=1e-3, bias=1e-3, walk=1e-5),
    DopplerLog(noise=0.01, scale=0.003, rate=5.0, dropout=0.02),
    DepthMeter(noise=0.01, bias=0.03),
    Compass(noise=0.005, bias=0.02, tilt=0.2),
)
"""MEMS gyroscopes, Doppler log, pressure sensor and magnetic compass of a small vehicle: round numbers."""

PRESETS: dict[str, tuple[Sensor, ...]] = {"auv": AUV}

Sensors: TypeAlias = str | Sequence[Sensor] | Mapping[str, Mapping[str, Any]] | None


def sensors_of(sensors: Sensors) -> tuple[Sensor, ...]:
    """Return sensors from the name of a preset, a list, or a dictionary of attributes by kind; None is none.

    Raises:
        InvalidInputError: it is none of these, there are two of a kind, or a value is wrong.
    """
    if sensors is None:
        return ()
    if isinstance(sensors, str):
        if sensors not in PRESETS:
            raise InvalidInputError(
                f"sensors = {sensors!r} is unknown; give one of {sorted(PRESETS)}, or a list"
            )
        return PRESETS[sensors]
    if isinstance(sensors, Mapping):
        return _from_mapping(sensors)
    given: list[Any] = list(sensors) if isinstance(sensors, Sequence) else [sensors]
    if not all(isinstance(one, Sensor) for one in given):
        raise InvalidInputError(
            f"sensors = {sensors!r}; give one of {sorted(PRESETS)}, a list of sensors, or a dictionary of them"
        )
    kinds = [type(one).__name__ for one in given]
    if len(set(kinds)) < len(kinds):
        raise InvalidInputError(f"sensors are {kinds}; give at most one of each kind")
    return tuple(given)


def shown_bounds(sensors: Sequence[Sensor]) -> list[float]:
    """Return the largest magnitudes of the numbers that sensors add to an observation, in their order."""
    return [bound for one in sensors for bound in (OLDEST, *one.shown)]


def nested_numbers(sensors: Sequence[Sensor], period: float) -> Any:
    """Return sensors as the kernel has them, nested in pairs (first, (second, (..., ())))."""
    nested: Any = ()
    for one in reversed(sensors):
        nested = (one.numbers(period), nested)
    return nested


def _from_mapping(given: Mapping[str, Mapping[str, Any]]) -> tuple[Sensor, ...]:
    unknown = sorted(set(given) - set(KINDS))
    if unknown:
        raise InvalidInputError(f"sensors has unknown kinds {unknown}; it takes {list(KINDS)}")
    made = []
    for name in filter(given.__contains__, KINDS):
        kind, attributes = KINDS[name], given[name]
        known = [one.name for one in fields(kind)]
        if not isinstance(attributes, Mapping) or not set(attributes) <= set(known):
            raise InvalidInputError(
                f"sensors[{name!r}] = {attributes!r}; give a dictionary with keys among {known}"
            )
        made.append(kind(**attributes))
    return tuple(made)
