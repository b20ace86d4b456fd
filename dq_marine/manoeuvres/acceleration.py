"""Acceleration from rest, under full throttle or less."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.manoeuvres.crossings import first_time_at, value_at
from dq_marine.manoeuvres.quantities import Quantity, Result, over
from dq_marine.manoeuvres.run import Run, Watch, unwatched
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.manoeuvres.setup import prepared
from dq_marine.vehicles import Vehicle


@dataclass(frozen=True, kw_only=True)
class Acceleration(Result):
    """Acceleration from rest.

    Attributes:
        top_speed: that it came to, ahead [m/s].
        settled: whether that speed was steady.
        time_63: to 63.2 % of it, 1 - 1/e, what a first-order lag needs one time constant for [s].
        time_90: to 90 % of it [s].
        distance_90: way by then [m].
    """

    manoeuvre: ClassVar[str] = "acceleration"

    top_speed: float
    settled: bool
    time_63: float | None
    time_90: float | None
    distance_90: float | None

    @property
    def speed_name(self) -> str:
        """What the speed at the end is called."""
        return "top speed" if self.settled else "speed at the end, not steady"

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        name = self.speed_name
        return (
            Quantity("top_speed_m_s", name, self.top_speed, "m/s"),
            Quantity("top_speed_lengths_s", name, self.top_speed / self.length, "L/s"),
            Quantity("time_63_s", "time to 63 % of it", self.time_63, "s"),
            Quantity("time_90_s", "time to 90 % of it", self.time_90, "s"),
            Quantity("distance_90_m", "way to 90 % of it", self.distance_90, "m"),
            Quantity("distance_90_lengths", "way to 90 % of it", over(self.distance_90, self.length), "L"),
        )


TIME_CONSTANT_SHARE = 0.6321205588285577
"""1 - 1/e."""


def acceleration(
    vehicle: Vehicle, *, conditions: Conditions | None = None, watch: Watch = unwatched
) -> Acceleration:
    """Accelerate from rest, the helm holding the heading, until the speed is steady.

    Args:
        vehicle: what is driven.
        conditions: full throttle unless given.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, or the vehicle cannot be driven and steered.
        StepNotSolvableError: the integrator refused a step.
    """
    setup = prepared(vehicle, conditions or Conditions())
    throttle = setup.conditions.throttle
    run = Run(setup, "acceleration", 0.0, watch)
    steady = run.settle(lambda: run.keep_heading(throttle), lambda: run.speed, setup.full_speed)
    series = run.series()
    speed, time = series.velocity_body[:, 0], series.time
    top = float(speed[-1])
    time_63, time_90 = (first_time_at(time, speed, share * top) for share in (TIME_CONSTANT_SHARE, 0.9))
    return Acceleration(
        vehicle=vehicle.name,
        length=setup.length,
        width=vehicle.dimensions.width,
        settings=setup.settings,
        step=setup.scene.step,
        series=series,
        notes=(
            *(() if steady.settled else ("The speed was still changing at the end.",)),
            *run_notes(vehicle, series),
        ),
        top_speed=top,
        settled=steady.settled,
        time_63=time_63,
        time_90=time_90,
        distance_90=value_at(time, series.distance, time_90),
    )
