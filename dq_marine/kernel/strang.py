"""Half kick, drift, half kick: Strang's method, of second order, for every scene."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.kernel.body import BodyState
from dq_marine.kernel.drift_report import drift_accepted
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    join_forces,
    make_flight,
    refusal,
)


class StrangTiming(NamedTuple):
    """Step size [s], and the parameters of the composition's kick over h/2 and over h."""

    h: float
    half_kick: Any
    full_kick: Any


def make_strang(composition: Composition) -> Advance:
    """Return the advance of Strang's method.

    The closing half kick of a step and the opening one of the next share a pose and are taken as one full kick.
    """
    add_forces = join_forces(composition.forces)
    kick, fly = composition.kick, make_flight(composition)

    def strang(parameters: StepParameters, state: BodyState, wrench: Spatial, steps: int) -> StepOutcome:
        timing, inertia = parameters.timing, parameters.inertia
        pose = state.pose
        force = add_forces(parameters.forces, pose, wrench)
        momentum = kick(timing.half_kick, inertia, state.momentum, force)
        iterations = 0
        rescued = 0
        worst = 0.0
        for completed in range(steps):
            flown = fly(parameters, timing.h, pose, momentum)
            iterations += flown.report.iterations
            rescued += flown.rescued
            worst = max(worst, flown.report.relative_residual_squared)
            if not drift_accepted(flown.report):
                return refusal(state, completed, iterations, rescued, flown.report)
            pose = flown.pose
            force = add_forces(parameters.forces, pose, wrench)
            closing = timing.half_kick if completed == steps - 1 else timing.full_kick
            momentum = kick(closing, inertia, flown.momentum, force)
        return arrival(state, pose, momentum, steps, iterations, rescued, worst)

    return strang
