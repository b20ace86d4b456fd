"""Half kick, drift, half kick: Strang's method, of second order, for every scene."""

from __future__ import annotations

from typing import Any, NamedTuple

from dq_marine.algebra.selection import some
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.forces import make_forced_kick
from dq_marine.integrator.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    make_flight,
    progress_by_step,
    progress_with,
    set_out,
)


class StrangTiming(NamedTuple):
    """Step size [s], and the parameters of the composition's kick: opening a step, closing one, and both at once.

    The first two last h/2, the third h. The numbers of the fluid memory are for h/2; () without.
    """

    h: float
    opening: Any
    closing: Any
    between: Any
    memory: Any = ()


def make_strang(composition: Composition) -> Advance:
    """Return the advance of Strang's method.

    The closing half kick of a step and the opening one of the next share a pose and are taken as one full kick. The
    fluid memory, where there is one, flows for half a step before the drift and for half a step after it.
    """
    kick = make_forced_kick(composition.kick, composition.forces)
    fly, remember = make_flight(composition), composition.memory.flow

    def strang(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        timing, inertia = parameters.timing, parameters.inertia
        forces, damping = parameters.forces, parameters.damping
        pose = state.pose
        momentum = kick(forces, damping, inertia, timing.opening, pose, state.momentum, time, wrench)
        memory = state.fluid_memory
        progress = set_out(state)
        for step in range(steps):
            momentum, memory = remember(timing.memory, momentum, memory)
            flown = fly(parameters, time + step * timing.h, timing.h, pose, momentum, progress.under_way)
            progress = progress_by_step(progress_with(progress, flown))
            if not some(progress.under_way):
                break
            pose = flown.pose
            momentum, memory = remember(timing.memory, flown.momentum, memory)
            node = time + (step + 1) * timing.h
            following = timing.closing if step == steps - 1 else timing.between
            momentum = kick(forces, damping, inertia, following, pose, momentum, node, wrench)
        return arrival(state, pose, momentum, memory, progress)

    return strang
