"""Free motion by Gauss's collocation on the momentum: drifts over any number of steps, four side by side.

The momentum at the stages comes from `gauss_stages`, the pose from the series of the twist that goes with it. The pose
is then made consistent with the momentum (G6) and its energy (G10), and the momentum that is handed on is the old one,
carried by the pose: the spatial momentum is exact to round-off. The method is not variational: no discrete action
stands behind it, and the symplectic form is kept only to the order of the method.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_position,
    pose_renormalise,
)
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import negation, select, some, spread
from dq_marine.algebra.spatial import ZERO, Spatial, quadratic_form, spatial_add, spatial_dot, spatial_scale
from dq_marine.algebra.stages import each_stage, stages_apart, stages_together
from dq_marine.integrator.collocation import Collocation, gauss
from dq_marine.integrator.drift import transport_momentum
from dq_marine.integrator.drift_report import (
    DriftReport,
    SolverReport,
    is_energy_kept,
    nothing_solved,
    report_of_either,
    worst,
)
from dq_marine.integrator.energy_level import MOST_LEVELLINGS, Nearer, is_far_from_level, levelling
from dq_marine.integrator.gauss_stages import (
    FreeBody,
    FreeStage,
    SweptStages,
    make_begin,
    make_sweep_stages,
    squared_length,
)
from dq_marine.integrator.increment import (
    AT_ONCE,
    Increment,
    Twists,
    as_pose,
    carried,
    consistent,
    increment_of,
    joined,
    renormalised,
    shifted,
)
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.sweeps import BRISKLY, CAREFULLY, Ending

FreeSteps: TypeAlias = Callable[
    [Inertia, float, int, DualQuaternion, Spatial], tuple[DualQuaternion, Spatial, DriftReport]
]
"""(inertia, h, steps, pose, momentum) -> (pose, momentum, report)."""

FOUR = (1.0, 1.0, 1.0, 1.0)
"""Steps whose motions are found side by side, as stages are."""


class Levelled(NamedTuple):
    """An increment after which a body has the energy it had before.

    Attributes:
        increment: the one on the energy's level.
        energy_kept: whether it nearly had that energy anyway.
        settled: whether it has it now, and little had to be changed.
    """

    increment: Increment
    energy_kept: bool
    settled: bool


def on_energy_level(body: FreeBody, increment: Increment, before: Spatial) -> Levelled:
    """Return the increment after which the momentum has the energy it had before (G10): Newton's method.

    One step of it does but for long steps.
    """
    nearer = nearer_to_energy_level(body, increment, before)
    level, excess = nearer.increment, nearer.excess
    far = is_far_from_level(nearer)
    count = 1
    while some(far) and count < MOST_LEVELLINGS:
        again = nearer_to_energy_level(body, level, before)
        level = select(far, again.increment, level)
        far = far & is_far_from_level(again)
        count += 1
    energy_kept = is_energy_kept(nearer.energy, nearer.energy + excess)
    return Levelled(level, energy_kept, energy_kept & negation(far))


def nearer_to_energy_level(body: FreeBody, increment: Increment, before: Spatial) -> Nearer:
    """Return one step of Newton's method for (G10)."""
    after = carried(increment, before)
    twist = twist_from_momentum(body.inertia, after)
    rate = momentum_bracket(twist, after)
    had = quadratic_form(body.inertia.inverse, before)
    excess = spatial_dot(twist, after) - had
    delta = levelling(body.length_squared, rate, 0.5 * excess, had)
    return Nearer(shifted(increment, delta.angular, delta.linear), excess, had)


def moved_by(
    increment: Increment,
    pose: DualQuaternion,
    momentum: Spatial,
    report: DriftReport,
) -> tuple[DualQuaternion, Spatial, DriftReport]:
    """Return pose and momentum after a motion, and a drift's report."""
    step = as_pose(increment)
    after = pose_renormalise(dual_multiply(pose, step))
    return after, transport_momentum(pose.real, after.real, pose_position(step), momentum), report


class FreeMarch(NamedTuple):
    """What steps of free motion have come to.

    Attributes:
        momentum: at their end, times h (G3).
        increment: the motion since the start of the first.
        report: how the sweeps fared.
        first: the evaluations at all stages that the sweeps of the step that follows begin with.
    """

    momentum: Spatial
    increment: Increment
    report: SolverReport
    first: FreeStage


def make_march_four(method: Collocation) -> Callable[[FreeBody, int, bool, FreeMarch, Ending], FreeMarch]:
    """Return (body, count, whether a step was before, what is before, ending) -> one to four steps more.

    Their momentum is found one after the other, then their motions side by side; steps that are not wanted do not move.
    """
    sweep_stages = make_sweep_stages(method)

    def one_more(
        body: FreeBody, wanted: bool, before: SweptStages, c: Spatial, ending: Ending
    ) -> SweptStages:
        if wanted:
            return sweep_stages(body, c, before.following, True, ending)
        like = c.linear[0]
        still = spread(ZERO, like)
        return SweptStages((still, still, still, still), still, nothing_solved(like), before.following)

    def march_four(body: FreeBody, count: int, ahead: bool, before: FreeMarch, ending: Ending) -> FreeMarch:
        c0 = before.momentum
        first = sweep_stages(body, c0, before.first, ahead, ending)
        c1 = spatial_add(c0, first.change)
        second = one_more(body, count > 1, first, c1, ending)
        c2 = spatial_add(c1, second.change)
        third = one_more(body, count > 2, second, c2, ending)
        c3 = spatial_add(c2, third.change)
        fourth = one_more(body, count > 3, third, c3, ending)
        p, q, r, s = first.twists, second.twists, third.twists, fourth.twists
        twists = stages_together(
            (
                Twists(p[0], p[1], p[2], p[3]),
                Twists(q[0], q[1], q[2], q[3]),
                Twists(r[0], r[1], r[2], r[3]),
                Twists(s[0], s[1], s[2], s[3]),
            )
        )
        parts = stages_apart(FOUR, each_stage(FOUR, increment_of, (twists,)))
        moved = joined(joined(parts[0], parts[1]), joined(parts[2], parts[3]))
        report = worst(worst(first.report, second.report), worst(third.report, fourth.report))
        return FreeMarch(
            spatial_add(c3, fourth.change),
            joined(before.increment, moved),
            worst(before.report, report),
            fourth.following,
        )

    return march_four


class FreeRun(NamedTuple):
    """Steps of free motion: the increment of all, made consistent and levelled, and how they fared."""

    increment: Increment
    report: DriftReport
    settled: bool


def make_free_run(method: Collocation) -> Callable[[FreeBody, int, Spatial, Ending], FreeRun]:
    """Return (body, steps, momentum times h, ending of the sweeps) -> steps of free motion.

    They are made consistent (G6), (G10) at the end of all.
    """
    begin, march_four = make_begin(method), make_march_four(method)

    def free_run(body: FreeBody, steps: int, start: Spatial, ending: Ending) -> FreeRun:
        like = start.linear[0]
        reached = FreeMarch(start, spread(AT_ONCE, like), nothing_solved(like), begin(body, start))
        done = 0
        while done < steps and some(reached.report.on_rest_branch):
            reached = march_four(body, steps - done, done > 0, reached, ending)
            done += len(FOUR)
        moved = renormalised(reached.increment)
        increment = consistent(math.sqrt(body.length_squared), moved, start, reached.momentum)
        levelled = on_energy_level(body, increment, start)
        report = DriftReport(reached.report, levelled.energy_kept)
        return FreeRun(levelled.increment, report, levelled.settled)

    return free_run


def better(wanted: bool, run: FreeRun, before: FreeRun) -> FreeRun:
    """Return a run where it is wanted, else that before; iterations are those of both."""
    increment = select(wanted, run.increment, before.increment)
    report = report_of_either(wanted, run.report, before.report)
    return FreeRun(increment, report, select(wanted, run.settled, before.settled))


@functools.cache
def make_gauss_steps(stages: int) -> FreeSteps:
    """Return (inertia, h, steps, pose, momentum) -> (pose, momentum, report): steps of free motion.

    Their sweeps end early. Where the energy that those leave over cannot be taken away, the steps are taken once more,
    carefully.
    """
    free_run = make_free_run(gauss(stages))

    def gauss_steps(
        inertia: Inertia, h: float, steps: int, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        body = FreeBody(inertia, squared_length(inertia))
        start = spatial_scale(h, momentum)
        like = start.linear[0]
        wanted, ending = spread(True, like), BRISKLY
        found = FreeRun(spread(AT_ONCE, like), DriftReport(nothing_solved(like), wanted), wanted)
        for _ in range(2):
            run = free_run(body, steps, start, ending)
            found = better(wanted, run, found)
            wanted = run.report.solver.on_rest_branch & negation(run.settled)
            ending = CAREFULLY
            if not some(wanted):
                break
        return moved_by(found.increment, pose, momentum, found.report)

    return gauss_steps
