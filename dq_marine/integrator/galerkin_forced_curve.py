"""The curve of a Galerkin step under forces at one of its nodes: (V1) to (V5), with wrenches.

Forces are evaluated at the curve's pose and velocity and at the node's time (docs/theory.md, "The Galerkin step").
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion, dual_multiply, pose_from_parts
from dq_marine.algebra.quaternion import Quaternion, quaternion_dot, quaternion_scale
from dq_marine.algebra.spatial import Spatial, spatial_scale
from dq_marine.algebra.vector3 import Vector3, add, cross, scale
from dq_marine.integrator.galerkin_curve import (
    Momentum,
    attitude_from,
    is_plain,
    momentum_at,
    momentum_from,
    multiply_vector,
    outward,
    rates_of,
    turned,
    twist_at,
)
from dq_marine.integrator.staged import StageForces
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


def motion_with(plain: bool, gain: float, gamma: Quaternion, momentum: Momentum, twist: Spatial) -> Motion:
    """Return the motion at gamma, with 1/|gamma|^2, where momentum and twist are known."""
    turning = multiply_vector(outward(plain, gain, gamma), twist.angular)
    return Motion(momentum, twist, turning, scale(2.0, turned(gamma, gain + gain, twist.linear)))


def make_motion(stages: int) -> Callable[[Flight, Quaternion, float, Quaternion, Vector3], Motion]:
    """Return (flight, gamma, 1/|gamma|^2, half the sums of Pi and of 2 R f) -> the motion at a node."""
    plain = is_plain(stages)

    def motion(
        flight: Flight, gamma: Quaternion, gain: float, forcing: Quaternion, pushing: Vector3
    ) -> Motion:
        pi, linear = momentum_from(flight.start.angular, forcing), add(flight.start.linear, pushing)  # (V1)
        momentum = momentum_at(plain, gain, gamma, pi, linear)
        return motion_with(
            plain, gain, gamma, momentum, twist_at(flight.parameters.inertia.inverse, momentum)
        )

    return motion


ForcesAlong: TypeAlias = Callable[[Flight, float, Spatial, Quaternion, Vector3], Spatial]
"""(flight, part of the step that is over, twist times h, attitude, way since the start) -> the wrench, times h^2."""


def make_forces_along(forces_at: StageForces, carry: WaterCarry) -> ForcesAlong:
    """Return the forces on a body on its way. `carry` is what moving water does to a pose."""

    def forces_along(flight: Flight, part: float, twist: Spatial, unit: Quaternion, way: Vector3) -> Spatial:
        parameters, h = flight.parameters, flight.h
        pose = dual_multiply(flight.pose, pose_from_parts(unit, way))
        there = carry(parameters.water, flight.time, part * h, pose)
        acting = forces_at(
            parameters, there, spatial_scale(1.0 / h, twist), flight.time + part * h, flight.wrench
        )
        return spatial_scale(h * h, acting)

    return forces_along


def make_forced_node(
    stages: int, forces_along: ForcesAlong
) -> Callable[[Flight, float, Motion, Quaternion, Vector3], ForcedNode]:
    """Return (flight, part of the step that is over, motion, half the sums of its rates) -> the node."""
    plain = is_plain(stages)

    def forced_node(
        flight: Flight, part: float, motion: Motion, turn: Quaternion, way: Vector3
    ) -> ForcedNode:
        momentum, twist = motion.momentum, motion.twist
        gamma = attitude_from(turn)  # (V1); way: (V5)
        shrink = 1.0 / math.sqrt(quaternion_dot(gamma, gamma))
        unit, gain = quaternion_scale(shrink, gamma), shrink * shrink
        acting = forces_along(flight, part, twist, unit, way)
        whole = scale(2.0, add(cross(momentum.linear, twist.linear), acting.angular))
        free = rates_of(plain, gain, outward(plain, gain, gamma), momentum, twist, whole)  # (V4)
        push = turned(unit, 2.0, acting.linear)
        rates = ForcedRates(motion.turning, free.forcing, scale(2.0, push), motion.travelling)
        return ForcedNode(rates, add(turned(unit, 2.0, acting.angular), cross(way, push)), gamma, gain)

    return forced_node
