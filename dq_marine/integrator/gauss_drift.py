"""Free motion by Gauss's collocation on the momentum: drifts over one step, and over four at once.

The momentum at the stages comes from `gauss_stages`, the pose from the series of the twist that goes with it. The pose
is then made consistent with the momentum (G6) and its energy (G10), and the momentum that is handed on is the old one,
carried by the pose: the spatial momentum is exact to round-off. The method is not variational: no discrete action
stands behind it, and the symplectic form is kept only to the order of the method.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_position,
    pose_renormalise,
)
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.selection import select, some
from dq_marine.algebra.spatial import Spatial, quadratic_form, spatial_add, spatial_dot, spatial_scale
from dq_marine.algebra.stages import each_stage, stages_apart, stages_together
from dq_marine.integrator.collocation import gauss
from dq_marine.integrator.drift import Drift, transport_momentum
from dq_marine.integrator.drift_report import DriftReport, is_energy_kept, worst
from dq_marine.integrator.energy_level import FAR_FROM_LEVEL, Nearer, levelling
from dq_marine.integrator.gauss_stages import (
    FreeBody,
    make_begin,
    make_sweep_stages,
    squared_length,
)
from dq_marine.integrator.increment import (
    Increment,
    Twists,
    as_pose,
    carried,
    consistent,
    increment_of,
    joined,
    shifted,
)
from dq_marine.integrator.inertia import Inertia, twist_from_momentum

FOUR = (1.0, 1.0, 1.0, 1.0)
"""The steps of a batch, side by side as stages are."""


def fitted(length: float, twists: Twists, before: Spatial, after: Spatial) -> Increment:
    """Return the motion of a step, consistent with the momentum before and after it."""
    return consistent(length, increment_of(twists), before, after)


MOST_LEVELLINGS = 4
"""Steps of Newton's method to an energy level, at the most."""


class Levelled(NamedTuple):
    """An increment after which a body has the energy it had before, and whether it nearly had it anyway."""

    increment: Increment
    energy_kept: bool


def on_energy_level(body: FreeBody, increment: Increment, before: Spatial) -> Levelled:
    """Return the increment after which the momentum has the energy it had before (G10): Newton's method.

    One step of it does but for long steps.
    """
    nearer = nearer_to_energy_level(body, increment, before)
    level, excess = nearer.increment, nearer.excess
    far = abs(excess) > FAR_FROM_LEVEL * nearer.energy
    count = 1
    while some(far) and count < MOST_LEVELLINGS:
        again = nearer_to_energy_level(body, level, before)
        level = select(far, again.increment, level)
        far = far & (abs(again.excess) > FAR_FROM_LEVEL * nearer.energy)
        count += 1
    return Levelled(level, is_energy_kept(nearer.energy, nearer.energy + excess))


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


@functools.cache
def make_gauss_one(stages: int) -> Drift:
    """Return (inertia, h, pose, momentum) -> (pose, momentum, report): a step of free motion."""
    begin, sweep_stages = make_begin(gauss(stages)), make_sweep_stages(gauss(stages))

    def gauss_one(
        inertia: Inertia, h: float, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        body = FreeBody(inertia, squared_length(inertia))
        before = spatial_scale(h, momentum)
        swept = sweep_stages(body, before, begin(body, before), False)
        after = spatial_add(before, swept.change)
        p = swept.twists
        increment = fitted(math.sqrt(body.length_squared), Twists(p[0], p[1], p[2], p[3]), before, after)
        levelled = on_energy_level(body, increment, before)
        report = DriftReport(swept.report, levelled.energy_kept)
        return moved_by(levelled.increment, pose, momentum, report)

    return gauss_one


@functools.cache
def make_gauss_four(stages: int) -> Drift:
    """Return (inertia, h, pose, momentum) -> (pose, momentum, report): four steps of free motion.

    The momentum of four steps is found one after the other, then their motions side by side.
    """
    begin, sweep_stages = make_begin(gauss(stages)), make_sweep_stages(gauss(stages))

    def gauss_four(
        inertia: Inertia, h: float, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        body = FreeBody(inertia, squared_length(inertia))
        length = math.sqrt(body.length_squared)
        c0 = spatial_scale(h, momentum)
        first = sweep_stages(body, c0, begin(body, c0), False)
        c1 = spatial_add(c0, first.change)
        second = sweep_stages(body, c1, first.following, True)
        c2 = spatial_add(c1, second.change)
        third = sweep_stages(body, c2, second.following, True)
        c3 = spatial_add(c2, third.change)
        fourth = sweep_stages(body, c3, third.following, True)
        c4 = spatial_add(c3, fourth.change)
        p, q, r, s = first.twists, second.twists, third.twists, fourth.twists
        twists = stages_together(
            (
                Twists(p[0], p[1], p[2], p[3]),
                Twists(q[0], q[1], q[2], q[3]),
                Twists(r[0], r[1], r[2], r[3]),
                Twists(s[0], s[1], s[2], s[3]),
            )
        )
        before, after = stages_together((c0, c1, c2, c3)), stages_together((c1, c2, c3, c4))
        parts = stages_apart(FOUR, each_stage(FOUR, fitted, (length, twists, before, after)))
        increment = joined(joined(parts[0], parts[1]), joined(parts[2], parts[3]))
        levelled = on_energy_level(body, consistent(length, increment, c0, c4), c0)
        report = worst(worst(first.report, second.report), worst(third.report, fourth.report))
        return moved_by(levelled.increment, pose, momentum, DriftReport(report, levelled.energy_kept))

    return gauss_four
