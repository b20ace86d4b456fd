"""The bodies that are measured: a BlueROV2 Heavy with all its terms, and with some of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.lean_scenes import CURRENT, STEP, VEHICLE, changed, neutral
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import Scene, batch_of
from dq_marine.vehicles import Vehicle, load_vehicle

Array = NDArray[np.float64]


def full_scene(vehicle: Vehicle | str = VEHICLE) -> Scene:
    """Return the scene with everything: net weight, righting moment, damping, current."""
    return Scene(vehicle, current=CURRENT, step=STEP)


def wrenches(bodies: int) -> Array:
    """Return a wrench of its own for each body, up to a tenth of the limits, shape (bodies, 6)."""
    limits = load_vehicle(VEHICLE).wrench_limits
    return np.asarray(0.1 * limits * np.random.default_rng(0).uniform(-1.0, 1.0, (bodies, 6)))


def driven(
    scenes: Sequence[Scene], bodies: int, threads: int, arithmetic: str, precision: str = "float64"
) -> Batch:
    """Return bodies under way, each pushed by a wrench of its own."""
    batch = batch_of(scenes, bodies, threads=threads, arithmetic=arithmetic, precision=precision)
    batch.step(wrenches(bodies), steps=5)
    return batch


def check_all_went(batch: Batch) -> None:
    """Raise RuntimeError if a step was refused, for a body that stands costs nothing."""
    if batch.steps_refused:
        raise RuntimeError(f"{batch.steps_refused} calls were refused: {list(batch.refusals.items())[:3]}")


def terms_added_up() -> dict[str, Scene]:
    """Return scenes with one term more each, from none to all."""
    own = load_vehicle(VEHICLE)
    nothing = neutral(own)
    heavy = changed(nothing, "buoyancy", volume=own.buoyancy.volume)
    righted = changed(heavy, "buoyancy", center=own.buoyancy.center)
    linear = changed(righted, "damping", linear=own.damping.linear)
    quadratic = changed(linear, "damping", quadratic=own.damping.quadratic)
    return {
        "inertia alone": Scene(nothing, step=STEP),
        "+ net weight": Scene(heavy, step=STEP),
        "+ righting moment": Scene(righted, step=STEP),
        "+ linear damping": Scene(linear, step=STEP),
        "+ quadratic damping": Scene(quadratic, step=STEP),
        "+ current": Scene(quadratic, current=CURRENT, step=STEP),
    }
