"""The stopping test: from a steady approach to dead in the water, full astern or with the thrust off."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.approach import approached
from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.manoeuvres.crossings import first_time_at, value_at
from dq_marine.manoeuvres.quantities import Quantity, Result, degrees, over
from dq_marine.manoeuvres.run import Watch, unwatched
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.manoeuvres.setup import prepared
from dq_marine.vehicles import Vehicle

Order = Literal["astern", "off"]

THROTTLES = {"astern": -1.0, "off": 0.0}
"""Throttle for each order."""

REMAINING = {"astern": 0.0, "off": 0.05}
"""Share of the approach's speed at which the vehicle counts as stopped: without thrust it never quite is."""

LONGEST = 500.0
"""Times of one length that it may take."""


@dataclass(frozen=True, kw_only=True)
class Stopping(Result):
    """A stopping test, helm amidships, by the terms of Resolution MSC.137(76).

    Attributes:
        approach_speed: [m/s].
        stopping_time: from the order until the speed ahead has gone, down to a twentieth with the thrust off [s]; None
            if it did not, as for what follows.
        track_reach: way along the track by then [m].
        head_reach: way along the course of the approach [m].
        lateral_deviation: way to starboard of it [m].
        heading_change: by then, positive to starboard [rad].
        course_growth_rate: of deviations from the straight approach [1/s]; positive if unstable.
    """

    manoeuvre: ClassVar[str] = "stopping"

    approach_speed: float
    stopping_time: float | None
    track_reach: float | None
    head_reach: float | None
    lateral_deviation: float | None
    heading_change: float | None
    course_growth_rate: float

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        length = self.length
        limit = 15.0 if self.settings["order"] == "astern" else None
        return (
            Quantity("approach_speed_m_s", "approach speed", self.approach_speed, "m/s"),
            Quantity("stopping_time_s", "time to stop", self.stopping_time, "s"),
            Quantity("track_reach_m", "track reach", self.track_reach, "m", limit and limit * length),
            Quantity("track_reach_lengths", "track reach", over(self.track_reach, length), "L", limit),
            Quantity("head_reach_m", "head reach", self.head_reach, "m"),
            Quantity("lateral_deviation_m", "deviation to starboard", self.lateral_deviation, "m"),
            Quantity("heading_change_deg", "heading change", degrees(self.heading_change), "deg"),
        )


def stopping(
    vehicle: Vehicle,
    *,
    order: Order = "astern",
    conditions: Conditions | None = None,
    watch: Watch = unwatched,
) -> Stopping:
    """Run a stopping test.

    Args:
        vehicle: what stops.
        order: "astern" for full astern, "off" for no thrust.
        conditions: full throttle of the approach unless given.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, or the vehicle cannot be steered, or not be stopped so.
        StepNotSolvableError: the integrator refused a step.
    """
    if order not in THROTTLES:
        raise InvalidInputError(f"order = {order!r} is unknown; give 'astern' or 'off'")
    setup = prepared(vehicle, conditions or Conditions())
    setup.check_throttle(THROTTLES[order])
    start = approached(setup, "stopping", watch)
    run, slow = start.run, REMAINING[order] * start.speed
    while run.speed > slow and run.time < LONGEST * setup.time_scale:
        run.steer(THROTTLES[order], 0.0)
    series = run.series()
    time = series.time
    stopped = first_time_at(time, -series.velocity_body[:, 0], -slow)
    ahead, starboard = series.along_and_across().T
    return Stopping(
        vehicle=vehicle.name,
        length=setup.length,
        width=vehicle.dimensions.width,
        settings=setup.settings | {"order": order},
        step=setup.scene.step,
        series=series,
        notes=(
            *start.notes,
            *_notes(stopped, float(np.abs(series.heading_change).max()), float(time[-1])),
            *run_notes(vehicle, series),
        ),
        approach_speed=start.speed,
        stopping_time=stopped,
        track_reach=value_at(time, series.distance, stopped),
        head_reach=value_at(time, ahead, stopped),
        lateral_deviation=value_at(time, starboard, stopped),
        heading_change=value_at(time, series.heading_change, stopped),
        course_growth_rate=start.growth_rate,
    )


def _notes(stopped: float | None, largest_turn: float, duration: float) -> tuple[str, ...]:
    notes = []
    if stopped is None:
        notes.append(f"It had not stopped after {duration:.4g} s.")
    if largest_turn > 0.5 * math.pi:
        notes.append("It turned by more than 90 deg, helm amidships.")
    return tuple(notes)
