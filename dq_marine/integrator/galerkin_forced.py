"""The Galerkin step under forces: the Lagrange-d'Alembert principle at the step's own nodes.

All forces, damping among them, act at the nodes. The impulses that they leave add up to the change of the spatial
momentum, so what of it a force field keeps is kept exactly (docs/theory.md, "The Galerkin step", V8).
"""

from __future__ import annotations

from typing import Any

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_from_parts,
    pose_renormalise,
)
from dq_marine.algebra.quaternion import quaternion_scale
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import (
    Spatial,
    matrix6_transform,
    spatial_add_scaled,
    spatial_scale,
)
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.algebra.vector3 import dot, scale, subtract
from dq_marine.integrator.collocation import Collocation, half_matrix
from dq_marine.integrator.drift import transport_momentum
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.galerkin_curve import change_squared, last_attitude_from
from dq_marine.integrator.galerkin_first_curve import make_first_forced_nodes
from dq_marine.integrator.galerkin_forced_curve import (
    Flight,
    ForcedRates,
    make_forced_node,
    make_forces_along,
    make_motion,
)
from dq_marine.integrator.galerkin_sweeps import Scales, make_sweeps, scales_of
from dq_marine.integrator.staged import StageForces, Step
from dq_marine.integrator.step import StepParameters
from dq_marine.integrator.water import WaterCarry


def forced_change_squared(scales: Scales, after: ForcedRates, before: ForcedRates) -> float:
    """Return the squared change of a forced step's rates at a node."""
    turned = change_squared(after.turning, before.turning)
    moved = scales.turning * turned + scales.forcing * change_squared(after.forcing, before.forcing)
    push = subtract(after.pushing, before.pushing)
    return moved + scales.pushing * dot(push, push)


def make_forced_step(method: Collocation, forces_at: StageForces, carry: WaterCarry) -> Step:
    """Return a step under forces.

    The report says nothing of the energy, which forces change.
    """
    weights, nodes, halved = method.weights, method.nodes, half_matrix(method)
    forces_along = make_forces_along(forces_at, carry)
    first_nodes = make_first_forced_nodes(method, forces_along)
    motion_at, forced_node = make_motion(len(weights)), make_forced_node(len(weights), forces_along)

    def sweep(flight: Any, now: Any) -> Any:
        parts = stage_constants(nodes, flight.start.angular[0])
        forcing = stage_product(halved, now.rates.forcing)
        pushing = stage_product(halved, now.rates.pushing)
        motion = each_stage(weights, motion_at, (flight, now.attitude, now.gain, forcing, pushing))
        turn, way = stage_product(halved, motion.turning), stage_product(halved, motion.travelling)
        return each_stage(weights, forced_node, (flight, parts, motion, turn, way))

    sweeps = make_sweeps(method, sweep, forced_change_squared)

    def forced_step(
        parameters: StepParameters,
        time: float,
        h: float,
        pose: DualQuaternion,
        momentum: Spatial,
        wrench: Spatial,
    ) -> tuple[DualQuaternion, Spatial, DriftReport]:
        inverse, start = parameters.inertia.inverse, spatial_scale(h, momentum)
        flight = Flight(parameters, h, pose, start, time, wrench)
        twist = matrix6_transform(inverse, start)
        acting = forces_at(parameters, pose, spatial_scale(1.0 / h, twist), time, wrench)
        acting = spatial_scale(h * h, acting)
        first = first_nodes(flight, twist, acting)
        node, report = sweeps(flight, first, scales_of(inverse, start, twist, acting))
        sums = stage_sum(weights, node.rates)
        turn = last_attitude_from(quaternion_scale(0.5, sums.turning))
        way = scale(0.5, sums.travelling)
        impulse = Spatial(stage_sum(weights, node.moment), scale(0.5, sums.pushing))
        moved = pose_renormalise(dual_multiply(pose, pose_from_parts(turn, way)))
        pushed = spatial_add_scaled(momentum, 1.0 / h, impulse)  # (V8)
        carried = transport_momentum(pose.real, moved.real, way, pushed)  # (V7)
        return moved, carried, DriftReport(report, spread(True, report.relative_residual_squared))

    return forced_step
