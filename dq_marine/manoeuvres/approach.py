"""The approach: a steady speed on a steady heading, and whether the vehicle would hold it by itself."""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.manoeuvres.course_stability import course_growth_rate
from dq_marine.manoeuvres.run import Run, Watch, unwatched
from dq_marine.manoeuvres.setup import Setup


class Approach(NamedTuple):
    """The steady motion in which a manoeuvre begins.

    Attributes:
        run: at time 0 of the manoeuvre.
        speed: ahead [m/s].
        growth_rate: of deviations from the straight course, helm amidships [1/s].
        notes: what a reader should know.
    """

    run: Run
    speed: float
    growth_rate: float
    notes: tuple[str, ...]


def approached(setup: Setup, phase: str, watch: Watch = unwatched) -> Approach:
    """Return a run on its steady approach, the helm having held the heading."""
    throttle = setup.conditions.throttle
    run = Run(setup, phase, setup.full_speed * throttle, watch)
    steady = run.settle(lambda: run.keep_heading(throttle), lambda: run.speed, setup.full_speed)
    growth_rate = course_growth_rate(run)
    run.begin(lead=setup.time_scale)
    notes = []
    if not steady.settled:
        notes.append("The speed of the approach was still changing when the manoeuvre began.")
    if growth_rate > 0.0:
        notes.append(
            "Unstable on course: helm amidships, a small deviation from the straight course doubles in "
            f"{math.log(2.0) / growth_rate:.3g} s."
        )
    elif growth_rate == 0.0:
        notes.append(
            "Neutral: helm amidships, a small deviation of sway, yaw rate or roll neither grows nor dies out."
        )
    return Approach(run, run.speed, growth_rate, tuple(notes))
