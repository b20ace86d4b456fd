"""Range sensors that see what is about a vehicle: sonars, and a lidar above the water."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from dq_marine.task.world.beams import Fan, fan_forward, fan_round


class RangeFinder(NamedTuple):
    """A range sensor.

    Attributes:
        fan: (number of beams) -> where they point.
        beams: how many it has, if nothing else is said: an even number.
        scans: whether a head turns from beam to beam with each ping; else all beams ping at once.
        in_air: whether it sees what is above the water, and nothing below.
    """

    fan: Callable[[int], Fan]
    beams: int
    scans: bool
    in_air: bool


RANGE_FINDERS: Mapping[str, RangeFinder] = MappingProxyType(
    {
        "multibeam": RangeFinder(fan_forward, 24, scans=False, in_air=False),
        "scanning": RangeFinder(fan_forward, 24, scans=True, in_air=False),
        "lidar": RangeFinder(fan_round, 48, scans=False, in_air=True),
    }
)
"""By name: a forward multibeam sonar, a sonar whose head scans the same sector, and a lidar that sees all round."""
