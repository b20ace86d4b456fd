"""Gauss's collocation for whole scenes: order 8 for smooth forces, exact in the momentum that they leave alone.

Without forces a call is steps of free motion, four at a time (`gauss_drift`); with forces, steps with forces at the stages
(`gauss_forced`). A step whose sweeps do not converge is taken by the composition's fallback, a step of Strang's method, and
counted. Gauss's collocation on the momentum keeps energy, momentum and Casimirs of free bodies. It is not variational.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import every, negation, select, some
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.drift_report import DriftReport, drift_accepted
from dq_marine.integrator.gauss_drift import make_gauss_drift, make_gauss_four
from dq_marine.integrator.gauss_forced import ForcedStep, make_forced_step
from dq_marine.integrator.rescue import Stepped, make_take, solved
from dq_marine.integrator.step import (
    Advance,
    Composition,
    Progress,
    StepOutcome,
    StepParameters,
    arrival,
    set_out,
)

BATCH = 4
"""Free steps whose motions are found side by side."""

AdvanceSome: TypeAlias = Callable[[StepParameters, BodyState, Spatial, float, int, bool], StepOutcome]


class GaussTiming(NamedTuple):
    """Step size [s], and the timing of the fallback's method for it."""

    h: float
    fallback: Any


def is_zero(wrench: Spatial) -> bool:
    """Whether nothing pushes."""
    m, f = wrench.angular, wrench.linear
    return (m[0] == 0.0) & (m[1] == 0.0) & (m[2] == 0.0) & (f[0] == 0.0) & (f[1] == 0.0) & (f[2] == 0.0)


def only(progress: Progress, wanted: bool) -> Progress:
    """Return the progress of the wanted bodies; the others stay where they are."""
    return Progress(
        progress.under_way & wanted,
        progress.status,
        progress.completed,
        progress.iterations,
        progress.fallbacks,
        progress.residual_squared,
    )


def make_free_step(composition: Composition, stages: int) -> ForcedStep:
    """Return one step of free motion in water that drifts uniformly; arguments as of `make_forced_step`."""
    drift, arrive = make_gauss_drift(stages), composition.water.arrive

    def free_step(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        after, carried, report = drift(parameters.inertia, h, pose, momentum)
        return arrive(parameters.water, parameters.inertia, time, h, after, carried).pose, carried, report

    return free_step


def make_free(composition: Composition, stages: int) -> AdvanceSome:
    """Return (parameters, state, wrench, time, steps, wanted) -> the outcome of free motion.

    Four steps are tried at once. The bodies for which they fail, and the steps that are left over, go one by one.
    """
    four, arrive = make_gauss_four(stages), composition.water.arrive
    take = make_take(make_free_step(composition, stages), composition.fallback)

    def free(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int, wanted: bool
    ) -> StepOutcome:
        inertia, h = parameters.inertia, parameters.timing.h
        now = Stepped(state.pose, state.momentum, only(set_out(state), wanted))
        done = 0
        while done < steps:
            count = min(BATCH, steps - done)
            singly = now.progress.under_way
            if count == BATCH:
                node = time + done * h
                pose, momentum, report = four(inertia, h, now.pose, now.momentum)
                pose = arrive(parameters.water, inertia, node, BATCH * h, pose, momentum).pose
                fine = now.progress.under_way & drift_accepted(report)
                now = Stepped(
                    select(fine, pose, now.pose),
                    select(fine, momentum, now.momentum),
                    solved(now.progress, fine, report, BATCH),
                )
                singly = singly & negation(fine)
            if some(singly):
                for step in range(count):
                    now = take(parameters, wrench, time + (done + step) * h, h, now, singly)
            done += count
            if not some(now.progress.under_way):
                break
        return arrival(state, now.pose, now.momentum, now.progress)

    return free


def make_forced(composition: Composition, stages: int) -> AdvanceSome:
    """Return (parameters, state, wrench, time, steps, wanted) -> the outcome of motion under forces."""
    take = make_take(make_forced_step(composition, gauss(stages)), composition.fallback)

    def forced(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int, wanted: bool
    ) -> StepOutcome:
        h = parameters.timing.h
        now = Stepped(state.pose, state.momentum, only(set_out(state), wanted))
        for step in range(steps):
            now = take(parameters, wrench, time + step * h, h, now, wanted)
            if not some(now.progress.under_way):
                break
        return arrival(state, now.pose, now.momentum, now.progress)

    return forced


def either(chosen: bool, one: StepOutcome, other: StepOutcome) -> StepOutcome:
    """Return the outcome of two ways, of which each body went one."""
    return StepOutcome(
        select(chosen, one.state, other.state),
        select(chosen, one.status, other.status),
        select(chosen, one.completed, other.completed),
        one.iterations + other.iterations,
        select(chosen, one.fallbacks, other.fallbacks),
        select(chosen, one.residual_squared, other.residual_squared),
    )


@functools.cache
def make_gauss_method(stages: int) -> Callable[[Composition], Advance]:
    """Return the method of order 2 x stages: (composition) -> advance."""

    def make_gauss(composition: Composition) -> Advance:
        forced = make_forced(composition, stages)
        if composition.pose_forces or composition.velocity_forces:

            def under_forces(
                parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
            ) -> StepOutcome:
                return forced(parameters, state, wrench, time, steps, set_out(state).under_way)

            return under_forces
        free = make_free(composition, stages)

        def pushed_or_free(
            parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
        ) -> StepOutcome:
            unpushed = is_zero(wrench)
            nobody = set_out(state).under_way & negation(set_out(state).under_way)
            taken = arrival(state, state.pose, state.momentum, only(set_out(state), nobody))
            if some(unpushed):
                taken = free(parameters, state, wrench, time, steps, unpushed)
            if not every(unpushed):
                pushed = forced(parameters, state, wrench, time, steps, negation(unpushed))
                taken = either(unpushed, taken, pushed)
            return taken

        return pushed_or_free

    return make_gauss
