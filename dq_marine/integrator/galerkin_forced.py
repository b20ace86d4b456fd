"""The Galerkin step under forces: the Lagrange-d'Alembert principle at the step's own nodes.

All forces, damping among them, act at the nodes, at the curve's pose and velocity and at the node's time. The impulses
that they leave add up to the change of the spatial momentum, so what of it a force field keeps is kept exactly
(docs/theory.md, "The Galerkin step", V8).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import (
    DualQuaternion,
    dual_multiply,
    pose_from_parts,
    pose_renormalise,
)
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_conjugate,
    quaternion_dot,
    quaternion_multiply,
    quaternion_scale,
    quaternion_vector,
)
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import (
    Spatial,
    matrix6_transform,
    spatial_add_scaled,
    spatial_scale,
)
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product, stage_sum
from dq_marine.algebra.vector3 import Vector3, add, cross, dot, scale, subtract
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.drift import transport_momentum
from dq_marine.integrator.drift_report import DriftReport
from dq_marine.integrator.galerkin_curve import (
    Momentum,
    Rates,
    attitude_from,
    change_squared,
    momentum_from,
    outward,
    rates_of,
    turned,
    turned_back,
)
from dq_marine.integrator.galerkin_sweeps import (
    Scales,
    half_matrix,
    make_first_nodes,
    make_sweeps,
    scales_of,
)
from dq_marine.integrator.staged import StageForces, Step
from dq_marine.integrator.step import StepParameters
from dq_marine.integrator.water import WaterCarry


class ForcedRates(NamedTuple):
    """The rates at a node: those of a free step, and 2 R f and 2 R v."""

    turning: Quaternion
    forcing: Quaternion
    pushing: Vector3
    travelling: Vector3


class ForcedNode(NamedTuple):
    """A node of a forced step: its rates, and its moment times h^2 about the step's start, in the frame there."""

    rates: ForcedRates
    moment: Vector3


class Flight(NamedTuple):
    """What is the same at all nodes of a step: the numbers of its scene, where, when and how it starts, and h.

    `start` holds the scaled momenta, `wrench` the constant wrench.
    """

    parameters: StepParameters
    h: float
    pose: DualQuaternion
    start: Spatial
    time: float
    wrench: Spatial


def make_forced_node(
    stages: int, forces_at: StageForces, carry: WaterCarry
) -> Callable[[Flight, float, ForcedRates], ForcedNode]:
    """Return (flight, part of the step that is over, half the sums of the rates) -> the node.

    `carry` is what moving water does to a pose.
    """
    plain = stages < 3

    def forced_node(flight: Flight, part: float, half_sums: ForcedRates) -> ForcedNode:
        parameters, h, start = flight.parameters, flight.h, flight.start
        gamma = attitude_from(half_sums.turning)  # (V1)
        pi = momentum_from(start.angular, half_sums.forcing)
        way = half_sums.travelling  # (V5)
        shrink = 1.0 / math.sqrt(quaternion_dot(gamma, gamma))
        unit, gain = quaternion_scale(shrink, gamma), shrink * shrink
        e = outward(plain, gain, gamma)
        linear = turned_back(unit, 2.0, add(start.linear, half_sums.pushing))
        momentum = Momentum(quaternion_multiply(quaternion_conjugate(e), pi), linear)  # (V2)
        whole = Spatial(quaternion_vector(momentum.turning), linear)
        twist = matrix6_transform(parameters.inertia.inverse, whole)  # (V3)
        pose = dual_multiply(flight.pose, pose_from_parts(unit, way))
        there = carry(parameters.water, flight.time, part * h, pose)
        acting = forces_at(
            parameters, there, spatial_scale(1.0 / h, twist), flight.time + part * h, flight.wrench
        )
        moment, force = scale(h * h, acting.angular), scale(h * h, acting.linear)
        free = rates_of(
            plain, gain, e, momentum, twist, scale(2.0, add(cross(linear, twist.linear), moment))
        )  # (V4)
        rates = ForcedRates(
            free.turning,
            free.forcing,
            scale(2.0, turned(unit, 2.0, force)),
            scale(2.0, turned(unit, 2.0, twist.linear)),
        )
        about_start = cross(way, scale(0.5, rates.pushing))
        return ForcedNode(rates, add(turned(unit, 2.0, moment), about_start))

    return forced_node


def first_forced_node(rates: Rates, moment: Vector3, force: Vector3, velocity: Vector3) -> ForcedNode:
    """Return a guess of a node from the rates of free motion, and the wrench and velocity at the start."""
    forced = ForcedRates(rates.turning, rates.forcing, scale(2.0, force), scale(2.0, velocity))
    return ForcedNode(forced, moment)


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
    first_nodes = make_first_nodes(method)
    forced_node = make_forced_node(len(weights), forces_at, carry)

    def sweep(flight: Any, rates: ForcedRates) -> Any:
        parts = stage_constants(nodes, flight.start.angular[0])
        return each_stage(weights, forced_node, (flight, parts, stage_product(halved, rates)))

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
        guess = first_nodes(inverse, start, acting)
        pushes = (guess.rates, acting.angular, acting.linear, twist.linear)
        first = each_stage(weights, first_forced_node, pushes)
        node, report = sweeps(flight, first, scales_of(inverse, start, twist, acting))
        sums = stage_sum(weights, node.rates)
        turn = attitude_from(quaternion_scale(0.5, sums.turning))  # (V6)
        way = scale(0.5, sums.travelling)
        impulse = Spatial(stage_sum(weights, node.moment), scale(0.5, sums.pushing))
        moved = pose_renormalise(dual_multiply(pose, pose_from_parts(turn, way)))
        pushed = spatial_add_scaled(momentum, 1.0 / h, impulse)  # (V8)
        carried = transport_momentum(pose.real, moved.real, way, pushed)  # (V7)
        return moved, carried, DriftReport(report, spread(True, report.relative_residual_squared))

    return forced_step
