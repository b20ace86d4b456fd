"""Strang's method for a body that may touch something: contact follows every half kick.

Two half kicks are never taken as one here, because contact is not linear in time: so what rests on a surface is at rest
at the end of each step, and steps are the same however many a call takes.
"""

from __future__ import annotations

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


def make_touching(composition: Composition) -> Advance:
    """Return the advance of Strang's method with contact: half kick and touch, drift, half kick and touch."""
    kick = make_forced_kick(composition.kick, composition.forces)
    fly, remember = make_flight(composition), composition.memory.flow
    assert composition.contact is not None  # noqa: S101 - told to the type checker: chosen for scenes with solids
    touch = composition.contact(composition.water.twist)

    def touching(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        timing, inertia, solids = parameters.timing, parameters.inertia, parameters.contact
        forces, damping, half = parameters.forces, parameters.damping, 0.5 * parameters.timing.h
        pose, momentum, memory = state.pose, state.momentum, state.fluid_memory
        progress = set_out(state)
        for step in range(steps):
            node = time + step * timing.h
            momentum = kick(forces, damping, inertia, timing.opening, pose, momentum, node, wrench)
            momentum = touch(solids, parameters.water, inertia, half, pose, momentum)
            momentum, memory = remember(timing.memory, momentum, memory)
            flown = fly(parameters, node, timing.h, pose, momentum, progress.under_way)
            progress = progress_by_step(progress_with(progress, flown))
            if not some(progress.under_way):
                break
            pose = flown.pose
            momentum, memory = remember(timing.memory, flown.momentum, memory)
            node = time + (step + 1) * timing.h
            momentum = kick(forces, damping, inertia, timing.closing, pose, momentum, node, wrench)
            momentum = touch(solids, parameters.water, inertia, half, pose, momentum)
        return arrival(state, pose, momentum, memory, progress)

    return touching
