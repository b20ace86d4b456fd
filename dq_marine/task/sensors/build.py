"""Sensors of an environment, with their errors, rates and drop-outs.

An agent without sensors is given its true motion. With sensors, each of them replaces a part of that motion:

    Gyroscope        angular velocity
    DVL              velocity over ground
    DepthMeter       depth
    AHRS             attitude: heading and tilt
    GNSS             north and east position, near the surface only
    Accelerometer    specific force, which is added to the observation

What no sensor replaces stays true. Under water that is the horizontal position, as if from an acoustic positioning
system without errors; there is no dead reckoning. A sensor holds its last reading until the next, and adds the age of
that reading to the observation. An episode starts with a reading of each. Rewards, metrics and ends of episodes follow
from the true motion.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, TypeAlias

from dq_marine.algebra.nesting import nested
from dq_marine.algebra.vector3 import Vector3
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.task.sensors.instruments import (
    ACCELEROMETER,
    AHRS_INSTRUMENT,
    DEPTH_METER,
    DVL_INSTRUMENT,
    GNSS_RECEIVER,
    GYROSCOPE,
    MOST_FORCE,
)
from dq_marine.task.sensors.observing import OLDEST
from dq_marine.task.sensors.sensor import Sensor


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

    def limits(self, gravity: float) -> tuple[float, float]:
        """Return the acceleration of gravity [m/s^2]."""
        return (gravity, 0.0)


@dataclass(frozen=True, kw_only=True)
class DVL(Sensor):
    """A Doppler velocity log with bottom lock: velocity over ground in the body frame [m/s].

    Attributes:
        seabed: depth of the sea bed [m].
        reach: altitude above it up to which there is a reading [m].
    """

    instrument = DVL_INSTRUMENT
    seabed: float = 100.0
    reach: float = 200.0

    def limits(self, gravity: float) -> tuple[float, float]:
        """Return the depth of the sea bed, and the largest altitude [m]."""
        return (self.seabed, self.reach)


@dataclass(frozen=True, kw_only=True)
class DepthMeter(Sensor):
    """Depth from the pressure [m]."""

    instrument = DEPTH_METER


@dataclass(frozen=True, kw_only=True)
class GNSS(Sensor):
    """North and east position from satellites [m], while the vehicle is near the surface.

    Attributes:
        surface: largest depth of the body origin at which there is a fix [m].
    """

    instrument = GNSS_RECEIVER
    rate: float | None = 1.0
    surface: float = 0.5

    def limits(self, gravity: float) -> tuple[float, float]:
        """Return the largest depth with a fix [m]."""
        return (self.surface, 0.0)


@dataclass(frozen=True, kw_only=True)
class AHRS(Sensor):
    """Heading and tilt [rad].

    Attributes:
        tilt: all errors of roll and pitch, over those of the heading.
    """

    instrument = AHRS_INSTRUMENT
    tilt: float = 0.1

    def each(self, value: float, name: str) -> Vector3:
        """Return errors about north, east and down."""
        return (self.tilt * value, self.tilt * value, value)


KINDS: dict[str, type[Sensor]] = {
    "gyroscope": Gyroscope,
    "accelerometer": Accelerometer,
    "dvl": DVL,
    "depth_meter": DepthMeter,
    "gnss": GNSS,
    "ahrs": AHRS,
}
"""Kinds of sensors by name, in the order in which a dictionary of them is taken."""

AUV = (
    Gyroscope(noise=1e-3, bias=1e-3, walk=1e-5),
    DVL(noise=0.01, scale=0.003, rate=5.0, dropout=0.02),
    DepthMeter(noise=0.01, bias=0.03),
    AHRS(noise=0.005, bias=0.02, tilt=0.2),
)
"""MEMS gyroscopes, DVL, pressure sensor and magnetic AHRS of a small vehicle, in round numbers."""

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
                f"sensors = {shown(sensors)} is unknown; give one of {sorted(PRESETS)}, or a list"
            )
        return PRESETS[sensors]
    if isinstance(sensors, Mapping):
        return _from_mapping(sensors)
    given: list[Any] = list(sensors) if isinstance(sensors, Sequence) else [sensors]
    if not all(isinstance(one, Sensor) for one in given):
        raise InvalidInputError(
            f"sensors = {shown(sensors)}; give one of {sorted(PRESETS)}, a list of sensors, or a dictionary of them"
        )
    kinds = [type(one).__name__ for one in given]
    if len(set(kinds)) < len(kinds):
        raise InvalidInputError(f"sensors are {kinds}; give at most one of each kind")
    return tuple(given)


def plain_sensors(sensors: Sequence[Sensor]) -> dict[str, dict[str, Any]] | None:
    """Return sensors as a dictionary of attributes by kind, which `sensors_of` takes; None if there are none.

    Raises:
        InvalidInputError: one is not of this package.
    """
    names = {kind: name for name, kind in KINDS.items()}
    for one in sensors:
        if type(one) not in names:
            raise InvalidInputError(f"sensors has {shown(one)}, which has no JSON; give it in Python")
    return {names[type(one)]: asdict(one) for one in sensors} or None


def shown_numbers(sensors: Sequence[Sensor]) -> list[tuple[str, str, int, float, str]]:
    """Return name, unit, count, largest magnitude and meaning of what sensors add to an observation, in their order."""
    names = {kind: name for name, kind in KINDS.items()}
    shown = []
    for one in sensors:
        name = names.get(type(one), type(one).__name__.lower())
        shown.append((f"{name}_age", "s", 1, OLDEST, f"time since the last reading of the {name}"))
        shown += [
            (f"{name}_{number}", "", 1, bound, f"what the {name} reads")
            for number, bound in enumerate(one.shown)
        ]
    return shown


def nested_numbers(sensors: Sequence[Sensor], period: float, gravity: float) -> Any:
    """Return the numbers of sensors, nested in pairs (first, (second, (..., ()))).

    Args:
        sensors: in their order.
        period: between observations [s].
        gravity: of the scene [m/s^2], for accelerometers.
    """
    return nested([one.numbers(period, gravity) for one in sensors])


def _from_mapping(given: Mapping[str, Mapping[str, Any]]) -> tuple[Sensor, ...]:
    unknown = sorted(shown(name) for name in given if name not in KINDS)
    if unknown:
        raise InvalidInputError(f"sensors has unknown kinds {unknown}; it takes {list(KINDS)}")
    made = []
    for name in filter(given.__contains__, KINDS):
        kind, attributes = KINDS[name], given[name]
        known = [one.name for one in fields(kind)]
        if not isinstance(attributes, Mapping) or not set(attributes) <= set(known):
            raise InvalidInputError(
                f"sensors[{name!r}] = {shown(attributes)}; give a dictionary with keys among {known}"
            )
        made.append(kind(**attributes))
    return tuple(made)
