"""Keywords of tasks that keep an altitude over a seabed, and the numbers that follow from them for a vehicle."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from dq_marine.charts import SeabedChart, seabed_chart
from dq_marine.checks import finite_number
from dq_marine.envs.core.definition import EpisodeContext
from dq_marine.envs.core.places import starting_depth
from dq_marine.envs.core.range_settings import PING_KEYWORDS, RangeSettings, checked_ranging, ping_schedule
from dq_marine.envs.core.suitability import cruising_speed, paced, unable_to_dive_under_way
from dq_marine.errors import InvalidInputError
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.ground_flight import GroundFlight
from dq_marine.task.grounds import Grounds, make_charted_ground, make_wavy_ground
from dq_marine.task.ranging import Schedule
from dq_marine.task.world.keel import Keel

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

LEAST_DEPTH = 20.0
"""Of the vehicle over the highest crest; ten lengths of long vehicles [m]."""

ROOM = 2.0
"""Least depth of a chart, over the altitude to keep: episodes begin up to a fifth of it too high."""

QUIET = {"noise": 0.0, "dropout": 0.0, "current": 0.0}
DISTURBED = {"noise": 0.02, "dropout": 0.2, "current": 0.3, "randomise": "default", "sensors": "auv"}
"""Keywords of levels: nothing in the way of a vehicle but the seabed, and everything."""


OVER_GROUND: dict[str, Any] = {
    "lasting": ("seabed", *PING_KEYWORDS),
    "unsuitable": unable_to_dive_under_way,
    "vehicle": "remus100",
    "control_period": paced,
    "max_episode_steps": 2000,
}
"""What `define_task` is told of every task over ground."""


@dataclass(frozen=True)
class GroundSettings(RangeSettings):
    """Speed over ground [m/s]; altitude, longest wave of the seabed, reach of beams [vehicle lengths]; slope; sonar.

    A speed of None is three fifths of what the vehicle reaches, or can steer at. `slope` bounds that of the seabed. For
    `noise`, `dropout`, `rate` and `latency` of the beams see `RangeSettings`.

    A `seabed` is a chart, or the file of one, see `dq_marine.SeabedChart`; each episode then draws a place on it, and
    `wave` and `slope` mean nothing. None is a seabed of waves that each episode draws.
    """

    speed: float | None = None
    altitude: float = 4.0
    wave: float = 30.0
    slope: float = 0.6
    reach: float = 16.0
    seabed: Any = None


Given = TypeVar("Given", bound=GroundSettings)


def over_ground(given: Given, vehicle: Vehicle) -> Given:
    """Return the settings for a vehicle, checked.

    Raises:
        InvalidInputError: a value is wrong.
    """
    speed = cruising_speed(vehicle) if given.speed is None else given.speed
    altitude = finite_number("altitude", given.altitude, least=1.0, most=1e2)
    seabed = given.seabed if given.seabed is None else seabed_chart(given.seabed)
    if seabed is not None:
        _check_room(seabed, altitude * vehicle.dimensions.length)
    return replace(
        given,
        speed=finite_number("speed", speed, above=0.0, most=SPEED_BOUND),
        altitude=altitude,
        wave=finite_number("wave", given.wave, least=5.0, most=1e4),
        slope=finite_number("slope", given.slope, least=0.0, most=1.0),
        reach=finite_number("reach", given.reach, least=2.0 * altitude, most=1e3),
        seabed=seabed,
        **checked_ranging(given),
    )


def check_way(settings: GroundSettings, keyword: str, length: float) -> None:
    """Check that the way of an episode is on the chart, whichever way it goes.

    Args:
        settings: of the task, which are `over_ground`'s.
        keyword: that sets the length, for the message.
        length: of the way [m].

    Raises:
        InvalidInputError: the chart is shorter.
    """
    if settings.seabed is not None and min(settings.seabed.sides) < length:
        north, east = settings.seabed.sides
        raise InvalidInputError(
            f"seabed: {settings.seabed.name} is {north:g} m long and {east:g} m wide, and an episode goes {length:g} m "
            f"over it; give a chart of at least that both ways, or a smaller {keyword}"
        )


def formulas_by_ground(
    make_formulas: Callable[[Grounds], Mapping[str, Any]], waves: int
) -> Callable[[GroundSettings], Mapping[str, Any]]:
    """Return the `formulas` of a task, see `TaskDefinition`: by the kind of ground of settings, each made once.

    Args:
        make_formulas: (kind of ground) -> the task's formulas that are about it, by their names.
        waves: of a seabed without a chart.
    """
    made = functools.cache(make_formulas)

    def formulas(settings: GroundSettings) -> Mapping[str, Any]:
        if settings.seabed is None:
            return made(make_wavy_ground(waves))
        return made(make_charted_ground(*settings.seabed.depths.shape))

    return formulas


def make_schedule(beams: int) -> Callable[[GroundSettings, float], Schedule | None]:
    """Return the `schedule` of a task whose beams ping all at once, see `TaskDefinition`."""

    def schedule(settings: GroundSettings, period: float) -> Schedule | None:
        return ping_schedule(settings, beams, 1, period)

    return schedule


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
        () if settings.seabed is None else settings.seabed.sheet,
    )


def _check_room(seabed: SeabedChart, altitude: float) -> None:
    """Check that there is water over a vehicle that keeps an altitude [m] over the shallowest place of a chart."""
    shallowest = float(seabed.depths.min())
    if shallowest < ROOM * altitude:
        raise InvalidInputError(
            f"seabed: {seabed.name} is {shallowest:g} m deep where it is shallowest, and the vehicle keeps an altitude "
            f"of {altitude:g} m, over which it needs as much water; give one at least {ROOM * altitude:g} m deep, or a "
            "smaller altitude"
        )
