"""Steps that are tried by one method and, where it does not solve them, taken by another."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import negation, select, select_call, some, spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.staged import Step
from dq_marine.integrator.step import (
    ACCEPTED,
    Advance,
    Progress,
    StepOutcome,
    StepParameters,
    arrival,
    set_out,
)


class Stepped(NamedTuple):
    """Where steps led, and how the call fares."""

    pose: DualQuaternion
    momentum: Spatial
    progress: Progress


class FallbackTiming(NamedTuple):
    """Step size [s], and the timing of the advance that takes the steps which the method does not solve."""

    h: float
    fallback: Any


Take: TypeAlias = Callable[[StepParameters, Spatial, float, float, Stepped, bool], Stepped]


def usable(report: DriftReport) -> bool:
    """Whether steps may be used whose sweeps say themselves when they have converged."""
    return report.solver.on_rest_branch & report.energy_kept


def solved(progress: Progress, fine: bool, report: DriftReport, steps: int) -> Progress:
    """Return the progress after steps that solved the bodies that are `fine`."""
    solver = report.solver
    worst = max(progress.residual_squared, solver.relative_residual_squared)
    return Progress(
        progress.under_way,
        progress.status,
        progress.completed + select(fine, steps, 0),
        progress.iterations + solver.iterations,
        progress.fallbacks,
        select(fine, worst, progress.residual_squared),
    )


def fallen_back(progress: Progress, lost: bool, outcome: StepOutcome) -> Progress:
    """Return the progress after a step of the fallback for bodies that were lost; it counts once for each."""
    taken = outcome.status == ACCEPTED
    refused = lost & negation(taken)
    worst = max(progress.residual_squared, outcome.residual_squared)
    return Progress(
        progress.under_way & negation(refused),
        select(refused, outcome.status, progress.status),
        progress.completed + select(lost & taken, 1, 0),
        progress.iterations,
        progress.fallbacks + select(lost, 1, 0),
        select(lost, worst, progress.residual_squared),
    )


def make_take(step: Step, fallback: Advance) -> Take:
    """Return (parameters, wrench, time, h, now, wanted) -> where one step more leads the wanted bodies.

    Args:
        step: whose report says by `on_rest_branch` whether its equations are solved.
        fallback: with `timing.fallback` for its timing; of a scene without fluid memory.
    """

    def take(
        parameters: StepParameters, wrench: Spatial, time: float, h: float, now: Stepped, wanted: bool
    ) -> Stepped:
        pose, momentum, report = step(parameters, time, h, now.pose, now.momentum, wrench)
        asked = wanted & now.progress.under_way
        fine = asked & usable(report)
        pose, momentum = select(fine, pose, now.pose), select(fine, momentum, now.momentum)
        progress = solved(now.progress, fine, report, 1)
        lost = asked & negation(fine)
        if some(lost):
            inertia, damping, forces, water, timing, contact = parameters
            timed = StepParameters(inertia, damping, forces, water, timing.fallback, contact)
            state = BodyState(pose, momentum, ())
            none = spread(0, momentum.linear[0])
            unmoved = StepOutcome(state, none, none, 0, none, report.solver.relative_residual_squared)
            outcome = select_call(lost, fallback, (timed, state, wrench, time, 1), unmoved)
            pose, momentum = outcome.state.pose, outcome.state.momentum
            progress = fallen_back(progress, lost, outcome)
        return Stepped(pose, momentum, progress)

    return take


def make_advance_with_fallback(step: Step, fallback: Advance) -> Advance:
    """Return the advance of a method step by step; arguments as for `make_take`."""
    take = make_take(step, fallback)

    def advance(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        now = Stepped(state.pose, state.momentum, set_out(state))
        for step in range(steps):
            now = take(parameters, wrench, time + step * h, h, now, now.progress.under_way)
            if not some(now.progress.under_way):
                break
        return arrival(state, now.pose, now.momentum, state.fluid_memory, now.progress)

    return advance
