"""The direct spiral (Dieudonne): the steady yaw rate for each helm, from starboard to port and back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import positive_integer
from dq_marine.manoeuvres.approach import approached
from dq_marine.manoeuvres.conditions import Conditions, fraction
from dq_marine.manoeuvres.quantities import Quantity, Result, degrees
from dq_marine.manoeuvres.run import Run, Watch, unwatched
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.manoeuvres.setup import prepared
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

SMALLEST_LOOP = 0.01
"""Width [helm] below which a loop is no more than what the steady yaw rates are known to."""

LONGEST_SETTLING = 60
"""Times of one length that each helm is given."""


@dataclass(frozen=True)
class SpiralPoint:
    """One helm of the spiral.

    Attributes:
        helm: -1 to 1.
        yaw_rate: that it came to [rad/s].
        speed: ahead, then [m/s].
        settled: whether the yaw rate had stopped changing.
    """

    helm: float
    yaw_rate: float
    speed: float
    settled: bool


@dataclass(frozen=True, kw_only=True)
class Spiral(Result):
    """A spiral test.

    Attributes:
        to_port: points with the helm going from starboard to port.
        to_starboard: points with the helm going back.
        loop_width: of helm, between where the yaw rate changes sign on both branches, 0 without a loop; None if the
            largest helm did not turn the vehicle round on both.
        loop_height: of yaw rate, between the branches at helm 0 [rad/s]; None likewise.
        course_growth_rate: of deviations from the straight approach [1/s]; positive if unstable.
    """

    manoeuvre: ClassVar[str] = "spiral"

    to_port: tuple[SpiralPoint, ...]
    to_starboard: tuple[SpiralPoint, ...]
    loop_width: float | None
    loop_height: float | None
    course_growth_rate: float

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        both = (*self.to_port, *self.to_starboard)
        largest = max(abs(point.yaw_rate) for point in both)
        return (
            Quantity("largest_yaw_rate_deg_s", "largest rate of turn", degrees(largest), "deg/s"),
            Quantity("loop_width", "width of the loop", self.loop_width, "of full helm"),
            Quantity("loop_height_deg_s", "height of the loop at helm 0", degrees(self.loop_height), "deg/s"),
            Quantity(
                "course_growth_rate_1_s",
                "growth of deviations, helm amidships",
                self.course_growth_rate,
                "1/s",
            ),
        )


def spiral(
    vehicle: Vehicle,
    *,
    helm: float = 1.0,
    helms: int = 6,
    conditions: Conditions | None = None,
    watch: Watch = unwatched,
) -> Spiral:
    """Run a direct spiral.

    Args:
        vehicle: what turns.
        helm: largest, as a fraction of full helm.
        helms: how many to each side besides 0; they lie closer near 0.
        conditions: full throttle unless given.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, or the vehicle cannot be steered.
        StepNotSolvableError: the integrator refused a step.
    """
    helm, helms = fraction("helm", helm), positive_integer("helms", helms)
    setup = prepared(vehicle, conditions or Conditions())
    start = approached(setup, "spiral", watch)
    shares = np.linspace(-1.0, 1.0, 2 * helms + 1)
    rising = helm * shares * np.abs(shares)
    to_port = _branch(start.run, rising[::-1])
    to_starboard = _branch(start.run, rising)
    points = (*to_port, *to_starboard)
    width, height = loop(to_port, to_starboard)
    series = start.run.series()
    return Spiral(
        vehicle=vehicle.name,
        length=setup.length,
        width=vehicle.dimensions.width,
        settings=setup.settings | {"helm": helm, "helms": helms},
        step=setup.scene.step,
        series=series,
        notes=(*start.notes, *_notes(points, width), *run_notes(vehicle, series)),
        to_port=to_port,
        to_starboard=to_starboard,
        loop_width=width,
        loop_height=height,
        course_growth_rate=start.growth_rate,
    )


def loop(
    to_port: tuple[SpiralPoint, ...], to_starboard: tuple[SpiralPoint, ...]
) -> tuple[float, float] | tuple[None, None]:
    """Return width [helm] and height [rad/s] of the loop between two branches, 0 where there is none.

    None if the yaw rate did not come to the helm's side at the end of each.
    """
    if to_port[-1].yaw_rate >= 0.0 or to_starboard[-1].yaw_rate <= 0.0:
        return None, None
    falling = np.array([(point.helm, point.yaw_rate) for point in reversed(to_port)])
    rising = np.array([(point.helm, point.yaw_rate) for point in to_starboard])
    width = _zero(rising) - _zero(falling)
    height = float(np.interp(0.0, *falling.T) - np.interp(0.0, *rising.T))
    return max(width, 0.0), max(height, 0.0)


def _zero(branch: Array) -> float:
    """Return the helm at which the yaw rate changes sign, linear between points of increasing helm, shape (n, 2)."""
    helm, rate = branch.T
    positive = np.flatnonzero(rate > 0.0)
    if not positive.size:
        return float(helm[-1])
    first = int(positive[0])
    if first == 0:
        return float(helm[0])
    share = -rate[first - 1] / (rate[first] - rate[first - 1])
    return float(helm[first - 1] + share * (helm[first] - helm[first - 1]))


def _branch(run: Run, helms: Array) -> tuple[SpiralPoint, ...]:
    throttle, scale = run.setup.conditions.throttle, 1.0 / run.setup.time_scale
    points = []
    for helm in helms.tolist():
        advance = partial(run.steer, throttle, helm)
        steady = run.settle(advance, lambda: run.yaw_rate, scale, longest=LONGEST_SETTLING)
        points.append(SpiralPoint(helm, steady.value, run.speed, steady.settled))
    return tuple(points)


def _notes(points: tuple[SpiralPoint, ...], width: float | None) -> tuple[str, ...]:
    notes = []
    time_varying = sum(not point.settled for point in points)
    if time_varying:
        notes.append(f"At {time_varying} of {len(points)} helms the yaw rate did not become steady.")
    if width is None:
        notes.append("Full helm against the turn did not reverse it: the loop is wider than the helm.")
    elif width > SMALLEST_LOOP:
        notes.append("Two yaw rates stand at one helm, within the loop: it does not hold a straight course.")
    return tuple(notes)
