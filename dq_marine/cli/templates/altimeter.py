"""An altimeter: height above the sea bed, which joins the observation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dq_marine.algebra.vector3 import Vector3, bounded
from dq_marine.integrator.body import Motion
from dq_marine.task.sensors.errors import Instrument, SensorNumbers
from dq_marine.task.sensors.sensor import Sensor

HIGHEST = 1e3  # bound of what is shown [m]


def height(numbers: SensorNumbers, gain: Vector3, offset: Vector3, carried: Any, motion: Motion) -> Any:
    """Return the height above the sea bed [m], as a tuple of one number, with the errors that are handed over."""
    return (gain[0] * (numbers.limits[0] - motion.position_ned[2]) + offset[0],)


def in_reach(numbers: SensorNumbers, motion: Motion) -> bool:
    """Whether the echo comes back; where it does not, the last reading stands and its age grows."""
    return numbers.limits[0] - motion.position_ned[2] <= numbers.limits[1]


def told(values: tuple[float]) -> float:
    """Return what joins the observation."""
    return bounded(values[0], HIGHEST)


@dataclass(frozen=True, kw_only=True)
class Altimeter(Sensor):
    """Height above the sea bed [m].

    Attributes:
        seabed: its depth [m].
        reach: the greatest height that is measured [m].
    """

    instrument = Instrument(1, ((0.0,), ()), height, available=in_reach, show=told)
    shown = (HIGHEST,)
    seabed: float = 100.0
    reach: float = 99.0

    def limits(self, gravity: float) -> tuple[float, float]:
        """Return what the instrument finds in `numbers.limits`."""
        return (self.seabed, self.reach)
