"""The force-free step of the Galerkin variational integrators: orders 2, 4, 6 and 8 of one family.

The discrete Lagrangian of a step is the action, by s Gauss nodes, of the curve of `integrator.galerkin_curve` that
makes it stationary between the step's two ends. It depends on the increment alone: the step is left-invariant,
symplectic, symmetric, of order 2s, and keeps the spatial momentum (docs/theory.md, "The Galerkin step"). With one node
it is the midpoint scheme of `integrator.midpoint_drift`.
"""

from __future__ import annotations

import functools
from typing import Any

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_from_parts,
    pose_renormalise,
)
from dq_marine.algebra.quaternion import quaternion_scale
from dq_marine.algebra.spatial import Spatial, matrix6_transform, quadratic_form, spatial_scale
from dq_marine.algebra.stages import each_stage, stage_product, stage_sum
from dq_marine.integrator.collocation import gauss, half_matrix
from dq_marine.integrator.drift import Drift, transport_momentum
from dq_marine.integrator.drift_report import DriftReport, is_energy_kept
from dq_marine.integrator.galerkin_curve import Node, last_attitude_from, make_node_at, travelled
from dq_marine.integrator.galerkin_first_curve import make_first_nodes
from dq_marine.integrator.galerkin_sweeps import make_sweeps, relative_change_squared, scales_of
from dq_marine.integrator.inertia import Inertia


@functools.cache
def make_galerkin_drift(stages: int) -> Drift:
    """Return (inertia, h, pose, momentum) -> (pose, momentum, report): the step with so many nodes."""
    method = gauss(stages)
    weights, halved = method.weights, half_matrix(method)
    first_nodes, node_at = make_first_nodes(method), make_node_at(stages)

    def sweep(given: Any, now: Node) -> Any:
        inverse, start = given
        return each_stage(weights, node_at, (inverse, start, stage_product(halved, now.rates)))

    sweeps = make_sweeps(method, sweep, relative_change_squared)

    def drift(
        inertia: Inertia, h: float, pose: DualQuaternion, momentum: Spatial
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        inverse, start = inertia.inverse, spatial_scale(h, momentum)
        nothing = spatial_scale(0.0, start)
        scales = scales_of(inverse, start, matrix6_transform(inverse, start), nothing)
        node, report = sweeps((inverse, start), first_nodes(inverse, start), scales)
        turn = last_attitude_from(quaternion_scale(0.5, stage_sum(weights, node.rates.turning)))
        way = stage_sum(weights, each_stage(weights, travelled, (node.attitude, node.velocity)))
        moved = pose_renormalise(dual_multiply(pose, pose_from_parts(turn, way)))
        carried = transport_momentum(pose.real, moved.real, way, momentum)  # (V7)
        before = quadratic_form(inverse, start)
        after = quadratic_form(inverse, carried)
        return moved, carried, DriftReport(report, is_energy_kept(before, h * h * after))

    return drift
