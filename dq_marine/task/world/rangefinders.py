"""Range sensors that see what is about a vehicle: sonars, and a lidar above the water."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from dq_marine.task.world.beams import Fan, fan_forward, fan_round


class RangeFinder(NamedTuple):
    """A range sensor.

    Attributes:
        fan: where its beams point; their number is even.
        turns: pings of a sweep: 1 where all beams ping at once, their number where one head turns from beam to beam.
        in_air: whether it sees what is above the water, and nothing below.
    """

    fan: Fan
    turns: int
    in_air: bool

    @property
    def beams(self) -> int:
        """How many it has."""
        return len(self.fan.bearings)


RANGE_FINDERS: Mapping[str, RangeFinder] = MappingProxyType(
    {
        "multibeam": RangeFinder(fan_forward(24), 1, False),
        "scanning": RangeFinder(fan_forward(24), 24, False),
        "lidar": RangeFinder(fan_round(48), 1, True),
    }
)
"""By name: a forward multibeam sonar, a sonar whose head scans the same sector, and a lidar that sees all round."""
