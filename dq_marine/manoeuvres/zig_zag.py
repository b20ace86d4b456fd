"""The zig-zag test (Kempf): the helm is put over to the other side whenever the heading has turned by an angle."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_number, positive_integer
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.approach import approached
from dq_marine.manoeuvres.conditions import Conditions, fraction
from dq_marine.manoeuvres.crossings import first_time_at, value_at
from dq_marine.manoeuvres.quantities import Quantity, Result, degrees, over
from dq_marine.manoeuvres.run import Watch, unwatched
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.setup import prepared
from dq_marine.manoeuvres.sides import Side, sign_of
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

LONGEST = 300.0
"""Times of one length that the test may take."""

LARGEST_HEADING = math.pi
"""Heading change beyond which the manoeuvre is given up [rad]."""

INITIAL_TURN = math.radians(10.0)
"""Heading change up to which the initial turning ability is measured."""


@dataclass
class ZigZagHelmsman:
    """Puts the helm to one side until the heading has turned there by an angle, then to the other, and so on.

    Attributes:
        angle: heading change that reverses the helm, above 0 [rad].
        helm: to each side, above 0.
        side: of the helm now: 1 starboard, -1 port.
        reversals: so far.
    """

    angle: float
    helm: float
    side: float = 1.0
    reversals: int = field(default=0, init=False)

    def order(self, heading_change: float) -> float:
        """Return the helm at a heading change since the beginning [rad]."""
        if self.side * heading_change >= self.angle:
            self.side = -self.side
            self.reversals += 1
        return self.side * self.helm


@dataclass(frozen=True)
class Swing:
    """The motion after a reversal of the helm.

    Attributes:
        time: of the reversal [s].
        side: that the heading had turned to: 1 starboard, -1 port.
        overshoot: by how much further it turned to that side [rad]; None where it never came back.
        peak_time: when it was furthest there [s]; None likewise.
    """

    time: float
    side: float
    overshoot: float | None
    peak_time: float | None


@dataclass(frozen=True, kw_only=True)
class ZigZag(Result):
    """A zig-zag test.

    Attributes:
        angle: heading change that reverses the helm [rad].
        approach_speed: [m/s].
        initial_turning_time: to the first reversal [s]; None if it did not get there, as for what follows.
        initial_turning_distance: way along the track until the heading has turned by 10 degrees [m].
        swings: after each reversal.
        period: from one reversal to the next of the same side, mean of those after the first [s].
        course_growth_rate: of deviations from the straight approach [1/s]; positive if unstable.
    """

    manoeuvre: ClassVar[str] = "zig-zag"

    angle: float
    approach_speed: float
    initial_turning_time: float | None
    initial_turning_distance: float | None
    swings: tuple[Swing, ...]
    period: float | None
    course_growth_rate: float

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        distance = self.initial_turning_distance
        limits = self._overshoot_limits()
        overshoots = [
            Quantity(
                f"overshoot_{number + 1}_deg",
                f"overshoot {number + 1}, to {'starboard' if swing.side > 0.0 else 'port'}",
                degrees(swing.overshoot),
                "deg",
                limits.get(number),
            )
            for number, swing in enumerate(self.swings)
        ]
        return (
            Quantity("approach_speed_m_s", "approach speed", self.approach_speed, "m/s"),
            Quantity("initial_turning_time_s", "initial turning time", self.initial_turning_time, "s"),
            Quantity("initial_turning_distance_m", "track to 10 deg of heading change", distance, "m"),
            Quantity(
                "initial_turning_lengths",
                "track to 10 deg of heading change",
                over(distance, self.length),
                "L",
                2.5 if self._is_standard(10.0) else None,
            ),
            *overshoots,
            Quantity("period_s", "period", self.period, "s"),
            Quantity(
                "course_growth_rate_1_s",
                "growth of deviations, helm amidships",
                self.course_growth_rate,
                "1/s",
            ),
        )

    def _is_standard(self, angle_deg: float) -> bool:
        return math.isclose(math.degrees(self.angle), angle_deg)

    def _overshoot_limits(self) -> dict[int, float]:
        """Return the limits of MSC.137(76), sec. 5.3.3 [deg] of the first and second overshoot, by index from 0."""
        if self._is_standard(20.0):
            return {0: 25.0}
        if not self._is_standard(10.0):
            return {}
        seconds = min(max(self.length / self.approach_speed, 10.0), 30.0)
        return {0: 5.0 + 0.5 * seconds, 1: 17.5 + 0.75 * seconds}


def zig_zag(
    vehicle: Vehicle,
    *,
    angle: float = math.radians(10.0),
    helm: float | None = None,
    side: Side = "starboard",
    overshoots: int = 4,
    conditions: Conditions | None = None,
    watch: Watch = unwatched,
) -> ZigZag:
    """Run a zig-zag test.

    Args:
        vehicle: what turns.
        angle: heading change that reverses the helm, above 0 and below pi/2 [rad].
        helm: fraction of full helm, above 0 and at most 1; None for as much rudder as `angle`, but at most 1: full
            helm is the rudder's largest deflection, 35 degrees of a vehicle without.
        side: to which the helm is put first, "starboard" or "port".
        overshoots: how many are waited for.
        conditions: full throttle unless given.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, or the vehicle cannot be steered.
        StepNotSolvableError: the integrator refused a step.
    """
    angle, sign = _checked_angle(angle), sign_of(side)
    if helm is not None:
        fraction("helm", helm)
    overshoots = positive_integer("overshoots", overshoots)
    setup = prepared(vehicle, conditions or Conditions())
    helm = min(angle / setup.steering.full_angle, 1.0) if helm is None else float(helm)
    start = approached(setup, "zig-zag", watch)
    run, throttle = start.run, setup.conditions.throttle
    helmsman = ZigZagHelmsman(angle, helm, sign)
    while (
        helmsman.reversals <= overshoots
        and abs(run.heading) < LARGEST_HEADING
        and run.time < LONGEST * setup.time_scale
    ):
        run.steer(throttle, helmsman.order(run.heading))
    series = run.series()
    swings = swings_of(series, angle)[:overshoots]
    turning = first_time_at(series.time, sign * series.heading_change, INITIAL_TURN)
    return ZigZag(
        vehicle=vehicle.name,
        length=setup.length,
        width=vehicle.dimensions.width,
        settings=setup.settings | {"angle_deg": math.degrees(angle), "helm": helm, "side": side},
        step=setup.scene.step,
        series=series,
        notes=(*start.notes, *_notes(swings, series), *run_notes(vehicle, series)),
        angle=angle,
        approach_speed=start.speed,
        initial_turning_time=swings[0].time if swings else None,
        initial_turning_distance=value_at(series.time, series.distance, turning),
        swings=swings,
        period=_period(swings),
        course_growth_rate=start.growth_rate,
    )


def swings_of(series: Series, angle: float) -> tuple[Swing, ...]:
    """Return what happened after each reversal of the helm, from a series whose helm zig-zags."""
    under_way = series.time >= 0.0
    time, helm, turned = series.time[under_way], series.helm[under_way], series.heading_change[under_way]
    reversals = [*(np.flatnonzero(np.diff(np.sign(helm)) != 0.0) + 1), len(time)]
    swings = []
    for begin, end in pairwise(reversals):
        side = -float(np.sign(helm[begin]))
        beyond = side * turned[begin:end] - angle
        peak = int(beyond.argmax())
        came_back = bool(beyond[-1] < 0.0)
        swings.append(
            Swing(
                time=float(time[begin]),
                side=side,
                overshoot=float(beyond[peak]) if came_back else None,
                peak_time=float(time[begin + peak]) if came_back else None,
            )
        )
    return tuple(swings)


def _checked_angle(angle: float) -> float:
    number = finite_number("angle", angle, above=0.0)
    if number >= 0.5 * math.pi:
        raise InvalidInputError(
            f"angle = {number:g} rad is not below pi/2; give less: 10 or 20 degrees are usual"
        )
    return number


def _period(swings: tuple[Swing, ...]) -> float | None:
    """Return the mean time between reversals of the same side, without the first swing, which starts from rest."""
    times = [swing.time for swing in swings][1:]
    cycles = np.subtract(times[2:], times[:-2])
    return float(cycles.mean()) if cycles.size else None


def _notes(swings: tuple[Swing, ...], series: Series) -> tuple[str, ...]:
    if not swings:
        return (f"The helm did not turn it by the angle in {series.time[-1]:.4g} s.",)
    if swings[-1].overshoot is None:
        return (f"After reversal {len(swings)}, the helm did not turn it back.",)
    return ()
