"""Keywords of tasks with a range sensor: what is wrong with its readings, and when it pings and tells."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from dq_marine.checks import finite_number, one_of, shown, whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.task.ranging import Schedule
from dq_marine.task.sensors.errors import LATE
from dq_marine.task.sensors.observing import OLDEST
from dq_marine.task.world.rangefinders import RANGE_FINDERS, RangeFinder

if TYPE_CHECKING:
    from dq_marine.vehicles import Vehicle

FASTEST = 1e6
"""Rate of pings [Hz]: of any above that of control there is one in every control period."""

MOST_BEAMS = 128
"""Of a range sensor: more take minutes to compile."""

PING_KEYWORDS = ("rate", "latency")
"""They choose what a memory holds, and so last as long as an environment does."""


@dataclass(frozen=True)
class RangeSettings:
    """What is wrong with the readings of a range sensor, and when they come.

    `noise` is their standard deviation [share of the reach], `dropout` the probability that one is lost, and reads as
    if nothing were there. There are `rate` pings in a second, or one in each control period if that is None, and what
    comes back is told `latency` after a ping [s]. Between pings the last readings are told again, and `range_ages`,
    which then joins the observation, says how old they are.
    """

    noise: float = 0.01
    dropout: float = 0.05
    rate: float | None = None
    latency: float = 0.0


def checked_ranging(given: RangeSettings) -> dict[str, Any]:
    """Return the keywords of a range sensor, checked.

    Raises:
        InvalidInputError: one is wrong.
    """
    rate = given.rate
    return {
        "noise": finite_number("noise", given.noise, least=0.0, most=1.0),
        "dropout": finite_number("dropout", given.dropout, least=0.0, most=0.9),
        "rate": None if rate is None else finite_number("rate", rate, least=1.0 / OLDEST, most=FASTEST),
        "latency": finite_number("latency", given.latency, least=0.0, most=OLDEST),
    }


def checked_finder(range_finder: Any, beams: Any, vehicle: Vehicle) -> dict[str, Any]:
    """Return `range_finder`, one of `RANGE_FINDERS`, and how many `beams` it has; None is as many as it has by itself.

    Raises:
        InvalidInputError: there is none of that name or with so many beams, or a vehicle under water is to see by light
            what is above it.
    """
    name: str = one_of("range_finder", range_finder, RANGE_FINDERS)
    finder = RANGE_FINDERS[name]
    count = finder.beams if beams is None else whole_number("beams", beams, least=2, most=MOST_BEAMS)
    if count % 2:
        raise InvalidInputError(
            f"beams = {shown(beams)} is odd, and their errors are drawn in pairs; give an even number"
        )
    if finder.in_air and vehicle.hydrostatics is None:
        under_water = [other for other, one in RANGE_FINDERS.items() if not one.in_air]
        raise InvalidInputError(
            f"range_finder = {shown(name)} sees what is above the water, and {vehicle.name} is under it; give one of "
            f"{under_water}, or a vessel that floats"
        )
    return {"range_finder": name, "beams": count}


def formulas_by_finder(
    make_formulas: Callable[[RangeFinder, int], Mapping[str, Any]],
) -> Callable[[Any], Mapping[str, Any]]:
    """Return the `formulas` of a task, see `TaskDefinition`: by `range_finder` and `beams`, each made once."""
    made = functools.cache(make_formulas)

    def formulas(settings: Any) -> Mapping[str, Any]:
        finder = RANGE_FINDERS[settings.range_finder]
        return made(finder, settings.beams or finder.beams)

    return formulas


def finder_schedule(settings: Any, period: float) -> Schedule | None:
    """Return when a range sensor pings, one of `RANGE_FINDERS` with so many `beams`; see `ping_schedule`."""
    turns = settings.beams if RANGE_FINDERS[settings.range_finder].scans else 1
    return ping_schedule(settings, settings.beams, turns, period)


def ping_schedule(settings: RangeSettings, beams: int, turns: int, period: float) -> Schedule | None:
    """Return when a range sensor pings; None of one that pings with all beams in every period, and tells at once.

    Args:
        settings: of the task, which are `checked_ranging`'s.
        beams: of the sensor.
        turns: pings of a sweep; a divisor of the beams.
        period: control period [s].

    Raises:
        InvalidInputError: readings would be told after those of the next ping are taken.
    """
    pinged = period if settings.rate is None else max(period, 1.0 / settings.rate)
    interval, latency = (math.ceil(time / period - LATE) for time in (pinged, settings.latency))
    if latency > interval:
        remedy = "give a latency of at most that" + ("" if settings.rate is None else ", or a lower rate")
        raise InvalidInputError(
            f"latency = {shown(settings.latency)} s, but the next ping follows after {interval * period:g} s, and one "
            f"at a time is under way; {remedy}"
        )
    if turns == 1 and interval == 1 and latency == 0:
        return None
    return Schedule(beams, turns, interval, latency, period)
