"""Radau's collocation for scenes with damping: of order 7, L-stable, and exact at the terminal velocity.

The stages of a step solve (docs/theory.md, eqs. RI1 and RI5)

    y_i = c + sum_j A_ij (ad*_(W y_j) y_j + h^2 F(p_j, chi_j, t_j)) + C_i                            (RI1)

with Radau's method IIA of four stages in place of Gauss's; F has the damping in it, and C is what quadrature misses
where a velocity passes through zero (`integrator.corner`). The last stage is where the step ends. Steps whose stages
are not found are taken by the composition's fallback, and counted.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    pose_from_parts,
    pose_position,
)
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import smallest_normal, spread
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.algebra.stages import each_stage, stage_constants, stage_sum, stages_apart
from dq_marine.algebra.vector3 import Vector3, add
from dq_marine.integrator.collocation import Collocation, radau
from dq_marine.integrator.corner import Corners, make_corners, make_no_corners
from dq_marine.integrator.damping import DampingAlgebra
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.fallback import make_advance_with_fallback
from dq_marine.integrator.forced_stages import Place, Surroundings, make_evaluate, multiplied
from dq_marine.integrator.gauss_stages import squared_length, weighted_square
from dq_marine.integrator.increment import unit
from dq_marine.integrator.inertia import Inertia, twist_from_momentum
from dq_marine.integrator.radau_sweeps import make_solve
from dq_marine.integrator.staged import Step
from dq_marine.integrator.step import Advance, Composition, StepParameters
from dq_marine.integrator.sweeps import same

STAGES = 4


class DampedTiming(NamedTuple):
    """Step size [s], the damping that Newton's method sees, and the timing of the fallback."""

    h: float
    damping: Any
    fallback: Any


def way_rate(inertia: Inertia, place: Place) -> Vector3:
    """Return h times the velocity in world axes (G8)."""
    return rotate(place.attitude, twist_from_momentum(inertia, place.momentum).linear)


def make_damped_step(
    composition: Composition, method: Collocation, algebra: DampingAlgebra, corners: Corners
) -> Step:
    """Return (parameters, time, h, pose, momentum, wrench) -> (pose, momentum, report): one step."""
    evaluate = make_evaluate(composition)
    solve = make_solve(method, evaluate, algebra, corners)
    carry = composition.water.at_stages.carry
    weights, nodes = method.weights, method.nodes

    def damped_step(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        like = momentum.linear[0]
        length_squared = squared_length(parameters.inertia)
        position = pose_position(pose)
        start = Place(spatial_scale(h, momentum), pose.real, spread((0.0, 0.0, 0.0), like))
        elapsed = each_stage(nodes, multiplied, (h, stage_constants(nodes, like)))
        around = Surroundings(parameters, length_squared, like, h, position, wrench, time, elapsed)
        # A force that sums over waves has numbers of one kind alone: those of all stages, as the time is.
        at_stages = each_stage(nodes, same, (start,))
        begun = each_stage(nodes, evaluate, (around, at_stages))
        pushed = stage_sum(weights, each_stage(nodes, weighted_square, (length_squared, begun.wrench)))
        size = weighted_square(length_squared, start.momentum) + pushed + smallest_normal(like)
        found, report = solve(around, parameters.timing.damping, start, begun, size)
        # The way is computed here: where no force asks for the position, the sweeps go without it.
        way = stage_sum(weights, each_stage(nodes, way_rate, (parameters.inertia, found)))
        _, _, _, end = stages_apart(nodes, found)
        after = pose_from_parts(unit(end.attitude), add(position, way))
        after = carry(parameters.water, time, h, after)
        return after, spatial_scale(1.0 / h, end.momentum), DriftReport(report, spread(True, like))

    return damped_step


@functools.cache
def make_radau_method(algebra: DampingAlgebra, *, grows: bool) -> Callable[[Composition], Advance]:
    """Return the method for one kind of damping matrix: (composition) -> advance.

    Args:
        algebra: of the matrix.
        grows: whether it depends on the velocity, so that there are corners.
    """
    method = radau(STAGES)
    corners = make_corners(method) if grows else make_no_corners(method)

    def make_radau(composition: Composition) -> Advance:
        step = composition.water.at_stages.step(make_damped_step(composition, method, algebra, corners))
        return make_advance_with_fallback(step, composition.fallback)

    return make_radau
