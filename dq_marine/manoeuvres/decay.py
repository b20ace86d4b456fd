"""The free decay test: released from an angle or a depth, the vehicle swings until its damping has stopped it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.checks import finite_number, one_of, positive_integer
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.decrement import Decrement, decrement_of
from dq_marine.manoeuvres.linear_modes import LinearMode, linear_mode, rest_of, stiffness_matrix
from dq_marine.manoeuvres.quantities import Quantity, Result
from dq_marine.manoeuvres.recorder import Recorder, sample_of
from dq_marine.manoeuvres.run import WATCH_EVERY, Watch, unwatched
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.setup import ACCURATE_STEP, radiation_setting, rounded_down, running_depth
from dq_marine.physics.radiation.build import CONSTANT
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, vehicle_sheet

Motion = Literal["roll", "pitch", "heave"]

AXES = {"heave": 2, "roll": 3, "pitch": 4}
"""Index of each motion in Fossen's order."""

RELEASE_ANGLE = math.radians(10.0)
RELEASE_HEAVE = 0.05
"""Heave at the release, over the length of the vehicle."""

SAMPLES, MOST_SAMPLES = 200, 20_000
"""Smallest and largest number of samples per period."""

GONE = 0.01
"""Share of the release below which the swings are too small to measure."""


@dataclass(frozen=True, kw_only=True)
class Decay(Result):
    """A free decay test.

    Attributes:
        motion: that was released.
        release: from where it was [rad, or m of heave].
        decrement: what the swings say; None if it came to rest without two of them.
        prediction: of the linear equations; None if they do not oscillate.
    """

    manoeuvre: ClassVar[str] = "decay"

    motion: Motion
    release: float
    decrement: Decrement | None
    prediction: LinearMode | None

    def quantities(self) -> tuple[Quantity, ...]:
        """Return the numbers that the manoeuvre was run for."""
        found, linear = self.decrement, self.prediction
        per_unit = "1/m" if self.motion == "heave" else "1/rad"
        return (
            Quantity("period_s", "period", found.period if found else None, "s"),
            Quantity(
                "damping_ratio",
                "damping ratio, mean of the swings",
                found.damping_ratio if found else None,
                "-",
            ),
            Quantity(
                "linear_damping_ratio",
                "damping ratio at no amplitude",
                found.linear_ratio if found else None,
                "-",
            ),
            Quantity("quadratic_damping", "quadratic part b", found.quadratic if found else None, per_unit),
            Quantity("swings", "half swings measured", float(len(found.ratios)) if found else 0.0, "-"),
            Quantity(
                "predicted_period_s", "period, linear equations", linear.period if linear else None, "s"
            ),
            Quantity(
                "predicted_damping_ratio",
                "damping ratio, linear equations",
                linear.damping_ratio if linear else None,
                "-",
            ),
        )


def decay(
    vehicle: Vehicle,
    *,
    motion: Motion = "roll",
    release: float | None = None,
    periods: int = 10,
    step: float | None = None,
    radiation: str = CONSTANT,
    watch: Watch = unwatched,
) -> Decay:
    """Run a free decay test, without thrust, in still water.

    Args:
        vehicle: what is released, at rest.
        motion: "roll", "pitch" or "heave".
        release: from where, above 0 [rad, or m of heave]; None for 10 degrees, or a twentieth of the length.
        periods: for how many of its own it is watched, at most.
        step: of the integrator [s]; None for one that suits the vehicle.
        radiation: "constant", or "memory" where the vehicle's file has added mass and damping by frequency; the linear
            equations have constant coefficients all the same.
        watch: told of the progress.

    Raises:
        InvalidInputError: a value is wrong, nothing brings the motion back, or there is no such radiation.
        StepNotSolvableError: the integrator refused a step.
    """
    axis = _checked_axis(vehicle, motion)
    release = _checked_release(vehicle, motion, release)
    periods = positive_integer("periods", periods)
    period = 2.0 * math.pi / natural_frequency(vehicle, axis)
    if step is None:
        step = rounded_down(min(period / SAMPLES, ACCURATE_STEP * vehicle_sheet(vehicle).largest_step))
    step = finite_number("step", step, least=period / MOST_SAMPLES)
    scene = Scene(vehicle, step=step, radiation=radiation)
    series = released(scene, axis, release, periods * period, watch)
    displacement = displacement_of(series, axis)
    found = decrement_of(series.time, displacement, GONE * release)
    return Decay(
        vehicle=vehicle.name,
        length=vehicle.dimensions.length,
        width=vehicle.dimensions.width,
        settings={
            "motion": motion,
            **({"release_m": release} if axis == 2 else {"release_deg": math.degrees(release)}),
            **radiation_setting(radiation),
        },
        step=scene.step,
        series=series,
        notes=() if found else ("It came to rest without swinging: no period, no damping ratio.",),
        motion=motion,
        release=release,
        decrement=found,
        prediction=linear_mode(vehicle, axis),
    )


def released(scene: Scene, axis: int, release: float, duration: float, watch: Watch) -> Series:
    """Return what happens in a time [s] after the release, at rest, so far from where it would stay."""
    body, recorder = scene.stepper(), Recorder()
    start = rest_of(scene.vehicle)
    start[axis - AXES["heave"]] += release
    heave, roll, pitch = start.tolist()
    body.reset((0.0, 0.0, running_depth(scene.vehicle) + heave), quaternion_from_euler(roll, pitch, 0.0))
    for sample in range(math.ceil(duration / scene.step)):
        recorder.add(sample_of(body), 0.0, 0.0)
        body.step()
        if sample % WATCH_EVERY == 0:
            watch("decay", body.time)
    return recorder.series(sample_of(body))


def displacement_of(series: Series, axis: int) -> NDArray[np.float64]:
    """Return roll or pitch [rad], or depth [m], shape (n,)."""
    return series.position_ned[:, 2] if axis == 2 else series.euler[:, axis - 3]


def natural_frequency(vehicle: Vehicle, axis: int) -> float:
    """Return about how fast an axis swings by itself [rad/s]: it sets scales, not results."""
    return math.sqrt(float(stiffness_matrix(vehicle)[axis, axis] / vehicle.mass_matrix[axis, axis]))


def _checked_axis(vehicle: Vehicle, motion: str) -> int:
    axis = AXES[one_of("motion", motion, AXES)]
    if stiffness_matrix(vehicle)[axis, axis] <= 0.0:
        remedy = (
            "only vessels that float have it"
            if motion == "heave"
            else "put the centre of mass below the centre of buoyancy"
        )
        raise InvalidInputError(
            f"nothing brings {vehicle.name!r} back in {motion}: it would not swing; {remedy}"
        )
    return axis


def _checked_release(vehicle: Vehicle, motion: str, release: float | None) -> float:
    if release is None:
        return RELEASE_HEAVE * vehicle.dimensions.length if motion == "heave" else RELEASE_ANGLE
    number = finite_number("release", release, above=0.0)
    if motion != "heave" and number >= 0.5 * math.pi:
        raise InvalidInputError(
            f"release = {number:g} rad is not below pi/2; give less: 10 degrees are usual"
        )
    return number
