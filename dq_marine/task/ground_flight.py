"""Flight at an altitude over the ground: the numbers that tasks of it share."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.task.world.keel import Keel


class GroundFlight(NamedTuple):
    """What a vehicle is to do over a seabed, and what it sees of it.

    Attributes:
        speed: to go at, over ground [m/s].
        altitude: to keep [m].
        depth: mean, of the seabed [m].
        slope: bound of the seabed's.
        wave: the longest of the seabed [m].
        reach: of beams [m].
        noise: standard deviation of their readings [m].
        dropout: probability that one is lost.
        keel: the hull from the side.
        period: of control [s].
    """

    speed: float
    altitude: float
    depth: float
    slope: float
    wave: float
    reach: float
    noise: float
    dropout: float
    keel: Keel
    period: float
