"""The turning circle: full helm from a steady approach, until the turn is steady."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from dq_marine.manoeuvres.approach import approached
from dq_marine.manoeuvres.conditions import Conditions, fraction
from dq_marine.manoeuvres.crossings import first_time_at, value_at
from dq_marine.manoeuvres.quantities import Quantity, Result, degrees, over
from dq_marine.manoeuvres.run import Run, Watch, unwatched
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.setup import prepared
from dq_marine.manoeuvres.sides import Side, sign_of
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

LEAST_HALF_CIRCLES = 3
"""That are turned."""

MOST_HALF_CIRCLES = 16

LONGEST = 300.0
"""Times of one length that the turn may take."""

STEADY_CHANGE = 0.002
"""Relative change of time and width from one half circle to the next below which the turn is steady."""


@dataclass(frozen=True)
class SteadyTurn:
    """Means over the last half circle, towards the side of the turn.

    Attributes:
        settled: whether the turn had become steady; if not, they are those of one half circle among unlike ones.
        radius: of the track [m].
        speed: in the horizontal plane [m/s].
        yaw_rate: of the heading [rad/s].
        drift_angle: positive where the bow points into the turn [rad].
        roll: positive where the vehicle leans into the turn [rad].
        centre: of the circle, ahead of and towards the turning side of the place where the helm was put over [m].
    """

    settled: bool
    radius: float
    speed: float
    yaw_rate: float
    drift_angle: float
    roll: float
    centre: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class TurningCircle(Result):
    """A turning circle, by the terms of Resolution MSC.137(76). Lengths from the place where the helm was put over.

    Attributes:
        side: of the turn.
        approach_speed: [m/s].
        advance: way ahead at 90 degrees of heading change [m]; None if it did not turn so far, as for what follows.
        transfer: way to the side at 90 degrees [m].
        tactical_diameter: way to the side at 180 degrees [m].
        time_90: to turn by 90 degrees [s].
        time_180: [s].
        time_360: [s].
        largest_roll: in magnitude [rad].
        steady: the turn at its end; None if it did not turn by 360 degrees.
        course_growth_rate: of deviations from the straight approach [1/s]; positive if unstable.
    """

    manoeuvre: ClassVar[str] = "turning-circle"

    side: Side
    approach_speed: float
    advance: float | None
    transfer: float | None
    tactical_diameter: float | None
    time_90: float | None
    time_180: float | None
    time_360: float | None
    largest_roll: float
    steady: SteadyTurn | None
    course_growth_rate: float

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        length, steady = self.length, self.steady
        which = "steady {}" if steady is None or steady.settled else "{} in the last half circle"
        return (
            Quantity("approach_speed_m_s", "approach speed", self.approach_speed, "m/s"),
            Quantity("advance_m", "advance at 90 deg", self.advance, "m", 4.5 * length),
            Quantity("advance_lengths", "advance at 90 deg", over(self.advance, length), "L", 4.5),
            Quantity("transfer_m", "transfer at 90 deg", self.transfer, "m"),
            Quantity(
                "tactical_diameter_m", "tactical diameter at 180 deg", self.tactical_diameter, "m", 5 * length
            ),
            Quantity(
                "tactical_diameter_lengths",
                "tactical diameter at 180 deg",
                over(self.tactical_diameter, length),
                "L",
                5.0,
            ),
            Quantity("time_90_s", "time to 90 deg", self.time_90, "s"),
            Quantity("time_180_s", "time to 180 deg", self.time_180, "s"),
            Quantity("time_360_s", "time to 360 deg", self.time_360, "s"),
            Quantity("steady_radius_m", which.format("radius"), steady.radius if steady else None, "m"),
            Quantity("steady_speed_m_s", which.format("speed"), steady.speed if steady else None, "m/s"),
            Quantity("speed_loss_percent", "loss of speed in the turn", self._speed_loss, "%"),
            Quantity(
                "yaw_rate_deg_s",
                which.format("rate of turn"),
                degrees(steady.yaw_rate if steady else None),
                "deg/s",
            ),
            Quantity(
                "drift_angle_deg",
                which.format("drift angle"),
                degrees(steady.drift_angle if steady else None),
                "deg",
            ),
            Quantity(
                "roll_deg",
                which.format("roll") + ", into the turn",
                degrees(steady.roll if steady else None),
                "deg",
            ),
            Quantity("largest_roll_deg", "largest roll", degrees(self.largest_roll), "deg"),
            Quantity(
                "course_growth_rate_1_s",
                "growth of deviations, helm amidships",
                self.course_growth_rate,
                "1/s",
            ),
        )

    @property
    def _speed_loss(self) -> float | None:
        return None if self.steady is None else 100.0 * (1.0 - self.steady.speed / self.approach_speed)


def turning_circle(
    vehicle: Vehicle,
    *,
    helm: float = 1.0,
    side: Side = "starboard",
    conditions: Conditions | None = None,
    watch: Watch = unwatched,
) -> TurningCircle:
    """Run a turning circle.

    Args:
        vehicle: what turns.
        helm: fraction of full helm, above 0 and at most 1.
        side: "starboard" or "port".
        conditions: full throttle unless given; the throttle stays as it was on the approach.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, or the vehicle cannot be steered.
        StepNotSolvableError: the integrator refused a step.
    """
    helm, sign = fraction("helm", helm), sign_of(side)
    setup = prepared(vehicle, conditions or Conditions())
    start = approached(setup, "turning circle", watch)
    run, throttle = start.run, setup.conditions.throttle
    settled = _turn(run, throttle, sign * helm)
    series = run.series()
    turned = sign * series.heading_change
    ahead, aside = series.along_and_across().T * np.array([[1.0], [sign]])
    under_way = series.time >= 0.0
    times = [first_time_at(series.time, turned, math.radians(angle)) for angle in (90.0, 180.0, 360.0)]
    steady = steady_turn(series, sign, settled=settled)
    return TurningCircle(
        vehicle=vehicle.name,
        length=setup.length,
        width=vehicle.dimensions.width,
        settings=setup.settings | {"helm": helm, "side": side},
        step=setup.scene.step,
        series=series,
        notes=(*start.notes, *_notes(steady, series), *run_notes(vehicle, series)),
        side=side,
        approach_speed=start.speed,
        advance=value_at(series.time, ahead, times[0]),
        transfer=value_at(series.time, aside, times[0]),
        tactical_diameter=value_at(series.time, aside, times[1]),
        time_90=times[0],
        time_180=times[1],
        time_360=times[2],
        largest_roll=float(np.abs(series.euler[under_way, 0]).max()),
        steady=steady,
        course_growth_rate=start.growth_rate,
    )


def _turn(run: Run, throttle: float, helm: float) -> bool:
    """Turn until the turn is steady or has taken its time; return whether it is."""
    marks = [(0.0, run.sample.position_ned)]
    while len(marks) <= MOST_HALF_CIRCLES and run.time < LONGEST * run.setup.time_scale:
        run.steer(throttle, helm)
        if math.copysign(1.0, helm) * run.heading >= len(marks) * math.pi:
            marks.append((run.time, run.sample.position_ned))
            if len(marks) > LEAST_HALF_CIRCLES and _is_steady(marks[-3:]):
                return True
    return False


def _is_steady(marks: list[tuple[float, Array]]) -> bool:
    """Return whether two half circles, from mark to mark, are alike in time and in width."""
    (_, start), (first, middle), (second, end) = marks
    begin = marks[0][0]
    pairs = (
        (first - begin, second - first),
        (float(np.linalg.norm(middle - start)), float(np.linalg.norm(end - middle))),
    )
    return all(abs(now - before) <= STEADY_CHANGE * now for before, now in pairs)


def steady_turn(series: Series, sign: float, *, settled: bool) -> SteadyTurn | None:
    """Return the turn, which has settled or not, over its last half circle; None if it is not all around."""
    turned = sign * series.heading_change
    end = float(turned[-1])
    if end < 2.0 * math.pi:
        return None
    time = series.time
    begin = _time_at(time, turned, end - math.pi)
    finish, last = float(time[-1]), time >= begin
    yaw_rate = math.pi / (finish - begin)
    speed = float(series.distance[-1] - np.interp(begin, time, series.distance)) / (finish - begin)
    radius = speed / yaw_rate
    track = series.along_and_across()[last] * np.array([1.0, sign])
    centre = (track + radius * _inward(track)).mean(axis=0)
    return SteadyTurn(
        settled=settled,
        radius=radius,
        speed=speed,
        yaw_rate=yaw_rate,
        drift_angle=sign * float(series.drift_angle[last].mean()),
        roll=sign * float(series.euler[last, 0].mean()),
        centre=(float(centre[0]), float(centre[1])),
    )


def _notes(steady: SteadyTurn | None, series: Series) -> tuple[str, ...]:
    if steady is None:
        turned = math.degrees(abs(float(series.heading_change[-1])))
        return (f"It turned by {turned:.0f} deg only in {series.time[-1]:.4g} s.",)
    if not steady.settled:
        return ("The turn did not become steady: its steady figures are means over the last half circle.",)
    return ()


def _time_at(time: Array, turned: Array, angle: float) -> float:
    """Return when the heading change was last below an angle [s]."""
    below = int(np.flatnonzero(turned < angle)[-1])
    return float(np.interp(angle, turned[below : below + 2], time[below : below + 2]))


def _inward(track: Array) -> Array:
    """Return unit vectors from a track that turns to its second coordinate towards its inside, shape (n, 2)."""
    tangent = np.gradient(track, axis=0)
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    return np.asarray(normal / np.hypot(*normal.T)[:, None])
