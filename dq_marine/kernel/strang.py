"""Half kick, drift, half kick: Strang's method, of second order, for every scene."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.kernel.body import BodyState
from dq_marine.kernel.drift_report import drift_accepted
from dq_marine.kernel.forces import make_forced_kick
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    make_flight,
    refusal,
)


class StrangTiming(NamedTuple):
    """Step size [s], and the parameters of the composition's kick: opening a step, closing one, and both at once.

    The first two last h/2, the third h.
    """

    h: float
    opening: Any
    closing: Any
    between: Any


def make_strang(composition: Composition) -> Advance:
    """Return the advance of Strang's method.

    The closing half kick of a step and the opening one of the next share a pose and are taken as one full kick.
    """
    kick = make_forced_kick(composition.kick, composition.pose_forces, composition.velocity_forces)
    fly = make_flight(composition)

    def strang(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        timing, inertia, forces = parameters.timing, parameters.inertia, parameters.forces
        pose = state.pose
        momentum = kick(forces, inertia, timing.opening, pose, state.momentum, time, wrench)
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
            node = time + (completed + 1) * timing.h
            following = timing.closing if completed == steps - 1 else timing.between
            momentum = kick(forces, inertia, following, pose, flown.momentum, node, wrench)
        return arrival(state, pose, momentum, steps, iterations, rescued, worst)

    return strang
