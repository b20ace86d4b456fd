"""Steps in runs of up to sixteen: of free motion, or with forces at the stages of a method.

A run that its method does not solve is taken step by step; a step that it does not solve is taken by the composition's
fallback, a step of Strang's method, and counted.
"""

from __future__ import annotations

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.selection import negation, select, some, spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.drift_report import DriftReport, SolverReport, report_of_either, worst
from dq_marine.integrator.fallback import Stepped, Take, make_advance_with_fallback, make_take, solved, usable
from dq_marine.integrator.gauss_drift import FreeSteps
from dq_marine.integrator.gauss_forced import Steps, one_of
from dq_marine.integrator.step import (
    Advance,
    Composition,
    StepOutcome,
    StepParameters,
    arrival,
    set_out,
)
from dq_marine.integrator.water import as_it_is

RUN = 16
"""Steps after which the pose is made consistent with the momentum, in calls of so many."""


def is_zero(wrench: Spatial) -> bool:
    """Whether nothing pushes."""
    m, f = wrench.angular, wrench.linear
    return (m[0] == 0.0) & (m[1] == 0.0) & (m[2] == 0.0) & (f[0] == 0.0) & (f[1] == 0.0) & (f[2] == 0.0)


def make_free_attempt(composition: Composition, free: FreeSteps) -> Steps:
    """Return (parameters, time, h, steps, pose, momentum, wrench) -> (pose, momentum, report): a run of free motion.

    By the report, bodies that a wrench pushes are not solved.
    """
    carry = composition.water.at_stages.carry

    def attempt(
        parameters: StepParameters,
        time: float,
        h: float,
        steps: int,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        unpushed = is_zero(wrench)
        solver = SolverReport(spread(0.0, momentum.linear[0]), unpushed, 0)
        report = DriftReport(solver, unpushed)
        if some(unpushed):
            pose, momentum, free_report = free(parameters.inertia, h, steps, pose, momentum)
            pose = carry(parameters.water, time, steps * h, pose)
            report = DriftReport(worst(solver, free_report.solver), free_report.energy_kept)
        return pose, momentum, report

    return attempt


def make_free_unless_pushed(free_attempt: Steps, forced: Steps) -> Steps:
    """Return the steps of free motion, and for bodies that a wrench pushes, those of the other method."""

    def steps_of_either(
        parameters: StepParameters,
        time: float,
        h: float,
        steps: int,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        after, handed_on, report = free_attempt(parameters, time, h, steps, pose, momentum, wrench)
        pushed = negation(is_zero(wrench))
        if some(pushed):
            moved, carried, other = forced(parameters, time, h, steps, pose, momentum, wrench)
            after, handed_on = select(pushed, moved, after), select(pushed, carried, handed_on)
            report = report_of_either(pushed, other, report)
        return after, handed_on, report

    return steps_of_either


def make_in_runs(attempt: Steps, take: Take, shortest: int) -> Advance:
    """Return the advance that tries a run of steps, and takes them one by one where that fails.

    Args:
        attempt: a run, whose report says whether its steps may be used.
        take: see `fallback.make_take`.
        shortest: steps that are worth an attempt.
    """

    def in_runs(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h = parameters.timing.h
        now = Stepped(state.pose, state.momentum, set_out(state))
        done = 0
        while done < steps and some(now.progress.under_way):
            node = time + done * h
            count = min(RUN, steps - done)
            rest = now.progress.under_way
            if count >= shortest:
                pose, momentum, report = attempt(parameters, node, h, count, now.pose, now.momentum, wrench)
                fine = rest & usable(report)
                now = Stepped(
                    select(fine, pose, now.pose),
                    select(fine, momentum, now.momentum),
                    solved(now.progress, fine, report, count),
                )
                rest = rest & negation(fine)
            if some(rest):
                for step in range(count):
                    now = take(parameters, wrench, node + step * h, h, now, rest)
            done += count
        return arrival(state, now.pose, now.momentum, state.fluid_memory, now.progress)

    return in_runs


def make_method_in_runs(composition: Composition, free: FreeSteps, forced: Steps) -> Advance:
    """Return the advance of a scene, by a method for free motion and one with forces."""
    water = composition.water.at_stages
    if composition.forceless:  # but for a wrench, under which bodies go step by step
        take = make_take(one_of(forced), composition.fallback)
        return make_in_runs(make_free_attempt(composition, free), take, shortest=1)
    if water.step is as_it_is:
        return make_in_runs(forced, make_take(one_of(forced), composition.fallback), shortest=2)
    return make_advance_with_fallback(water.step(one_of(forced)), composition.fallback)
