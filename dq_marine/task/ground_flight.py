"""Flight at an altitude over the ground: the numbers that tasks of it share, and what they are rewarded for."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.elementary import exponential
from dq_marine.algebra.selection import select
from dq_marine.task.common import effort
from dq_marine.task.protocol import Situation
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
        sheet: a `ChartSheet`, where the seabed is that of a chart; nothing where episodes draw it.
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
    sheet: Any = ()


class FlightRewards(NamedTuple):
    """Terms of the reward, and their weights: way made near the path, nearness, end, contact, effort."""

    progress: float = 0.4
    nearness: float = 0.6
    finish: float = 10.0
    contact: float = 20.0
    effort: float = 0.02


def flight_rewards(
    weights: FlightRewards, now: Situation, pace: float, off: float, succeeded: Any
) -> FlightRewards:
    """Return the terms of the reward.

    Args:
        weights: of the terms.
        now: the situation, whose metrics have the clearance of the hull from what is below [m].
        pace: speed along the path over that to go at.
        off: distance from the path over that at which it is hardly worth anything to be near.
        succeeded: whether the end is reached as it should be.
    """
    return FlightRewards(
        weights.progress * max(-1.0, min(pace, 2.0 - pace)) * exponential(-off),
        weights.nearness * exponential(-5.0 * off),
        weights.finish * select(succeeded, 1.0, 0.0),
        -(weights.contact * select(now.metrics.clearance < 0.0, 1.0, 0.0)),
        effort(weights.effort, now),
    )
