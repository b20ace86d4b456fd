"""Keywords of tasks that keep an altitude over a seabed, and the numbers that follow from them for a vehicle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from dq_marine.checks import finite_number
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.ground_flight import GroundFlight
from dq_marine.task.world.keel import Keel

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

LEAST_DEPTH = 20.0
"""Of the vehicle over the highest crest; ten lengths of long vehicles [m]."""

QUIET = {"noise": 0.0, "dropout": 0.0, "current": 0.0}
DISTURBED = {"noise": 0.02, "dropout": 0.2, "current": 0.3, "randomise": "default", "sensors": "auv"}
"""Keywords of levels: nothing in the way of a vehicle but the seabed, and everything."""


@dataclass(frozen=True)
class GroundSettings:
    """Speed over ground [m/s]; altitude, longest wave of the seabed, reach of beams [vehicle lengths]; slope; errors.

    A speed of None is three fifths of what the vehicle reaches, or can steer at. `slope` bounds that of the seabed.
    `noise` is the standard deviation of readings [share of the reach], `dropout` the probability that one is lost, and
    reads as if nothing were there.
    """

    speed: float | None = None
    altitude: float = 4.0
    wave: float = 30.0
    slope: float = 0.6
    reach: float = 16.0
    noise: float = 0.01
    dropout: float = 0.05


Given = TypeVar("Given", bound=GroundSettings)


def over_ground(given: Given, vehicle: Vehicle) -> Given:
    """Return the settings for a vehicle, checked.

    Raises:
        InvalidInputError: a value is wrong.
    """
    speed = cruising_speed(vehicle) if given.speed is None else given.speed
    altitude = finite_number("altitude", given.altitude, least=1.0, most=1e2)
    return replace(
        given,
        speed=finite_number("speed", speed, above=0.0, most=SPEED_BOUND),
        altitude=altitude,
        wave=finite_number("wave", given.wave, least=5.0, most=1e4),
        slope=finite_number("slope", given.slope, least=0.0, most=1.0),
        reach=finite_number("reach", given.reach, least=2.0 * altitude, most=1e3),
        noise=finite_number("noise", given.noise, least=0.0, most=1.0),
        dropout=finite_number("dropout", given.dropout, least=0.0, most=0.9),
    )


def ground_flight(settings: GroundSettings, context: EpisodeContext) -> GroundFlight:
    """Return the numbers that follow from settings, which are `over_ground`'s."""
    vehicle, size, speed = context.vehicle, context.vehicle.dimensions, settings.speed
    altitude, wave = settings.altitude * size.length, settings.wave * size.length
    crest = settings.slope * wave / math.tau  # no wave is higher: a = s / k
    return GroundFlight(
        cruising_speed(vehicle) if speed is None else speed,
        altitude,
        starting_depth(vehicle, LEAST_DEPTH) + altitude + crest,
        settings.slope,
        wave,
        settings.reach * size.length,
        settings.noise * settings.reach * size.length,
        settings.dropout,
        Keel(0.5 * size.length, 0.5 * size.height),
        context.control_period,
    )
