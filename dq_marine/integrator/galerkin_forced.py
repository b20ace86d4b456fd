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
    quaternion_dot,
    quaternion_scale,
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
    is_plain,
    momentum_at,
    momentum_from,
    multiply_vector,
    outward,
    rates_of,
    turned,
    twist_at,
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
    """A node of a forced step.

    Attributes:
        rates: at the node.
        moment: times h^2, about the step's start, in the frame there.
        attitude: gamma.
        gain: 1/|gamma|^2.
    """

    rates: ForcedRates
    moment: Vector3
    attitude: Quaternion
    gain: float


class Motion(NamedTuple):
    """How a body moves at a node: its momentum and twist, and the rates 2 gamma' and 2 R v that follow from them."""

    momentum: Momentum
    twist: Spatial
    turning: Quaternion
    travelling: Vector3


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


def make_motion(stages: int) -> Callable[[Flight, Quaternion, float, Quaternion, Vector3], Motion]:
    """Return (flight, gamma, 1/|gamma|^2, half the sums of Pi and of 2 R f) -> the motion at a node."""
    plain = is_plain(stages)

    def motion(
        flight: Flight, gamma: Quaternion, gain: float, forcing: Quaternion, pushing: Vector3
    ) -> Motion:
        pi, linear = momentum_from(flight.start.angular, forcing), add(flight.start.linear, pushing)  # (V1)
        momentum = momentum_at(plain, gain, gamma, pi, linear)
        twist = twist_at(flight.parameters.inertia.inverse, momentum)
        turning = multiply_vector(outward(plain, gain, gamma), twist.angular)
        return Motion(momentum, twist, turning, scale(2.0, turned(gamma, gain + gain, twist.linear)))

    return motion


def make_forced_node(
    stages: int, forces_at: StageForces, carry: WaterCarry
) -> Callable[[Flight, float, Motion, Quaternion, Vector3], ForcedNode]:
    """Return (flight, part of the step that is over, motion, half the sums of its rates) -> the node.

    `carry` is what moving water does to a pose.
    """
    plain = is_plain(stages)

    def forced_node(
        flight: Flight, part: float, motion: Motion, turn: Quaternion, way: Vector3
    ) -> ForcedNode:
        parameters, h, momentum, twist = flight.parameters, flight.h, motion.momentum, motion.twist
        gamma = attitude_from(turn)  # (V1); way: (V5)
        shrink = 1.0 / math.sqrt(quaternion_dot(gamma, gamma))
        unit, gain = quaternion_scale(shrink, gamma), shrink * shrink
        pose = dual_multiply(flight.pose, pose_from_parts(unit, way))
        there = carry(parameters.water, flight.time, part * h, pose)
        acting = forces_at(
            parameters, there, spatial_scale(1.0 / h, twist), flight.time + part * h, flight.wrench
        )
        moment, force = scale(h * h, acting.angular), scale(h * h, acting.linear)
        whole = scale(2.0, add(cross(momentum.linear, twist.linear), moment))
        free = rates_of(plain, gain, outward(plain, gain, gamma), momentum, twist, whole)  # (V4)
        push = turned(unit, 2.0, force)
        rates = ForcedRates(motion.turning, free.forcing, scale(2.0, push), motion.travelling)
        return ForcedNode(rates, add(turned(unit, 2.0, moment), cross(way, push)), gamma, gain)

    return forced_node


def first_forced_node(
    rates: Rates, attitude: Quaternion, moment: Vector3, force: Vector3, velocity: Vector3
) -> ForcedNode:
    """Return a guess of a node from the rates of free motion, gamma, and the wrench and velocity at the start."""
    forced = ForcedRates(rates.turning, rates.forcing, scale(2.0, force), scale(2.0, velocity))
    return ForcedNode(forced, moment, attitude, 1.0 / quaternion_dot(attitude, attitude))


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
    motion_at = make_motion(len(weights))
    forced_node = make_forced_node(len(weights), forces_at, carry)

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
        guess = first_nodes(inverse, start, acting)
        pushes = (guess.rates, guess.attitude, acting.angular, acting.linear, twist.linear)
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
