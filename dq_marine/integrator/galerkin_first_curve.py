"""The curves that the sweeps of a Galerkin step begin with: nearly those of Kirchhoff's equations in the body frame.

Sweeps of Kirchhoff's equations, with Gauss's matrix A, cost two thirds of a Galerkin step's own or less,

    y_j = c + sum_i A_ji (ad*_(W y_i) y_i + F_i),   Gamma_j = gamma_j (W y_j)_angular                  (V9)

and their collocation differs from that of the Galerkin step by what both err at the nodes: beyond a few sweeps the
first curve comes no closer. Forces are those at the step's start for the first sweeps, then those where the sweep
before has led.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_dot,
    quaternion_from_vector,
    quaternion_scale,
)
from dq_marine.algebra.spatial import Matrix6, Spatial, matrix6_transform, spatial_add, spatial_scale
from dq_marine.algebra.stages import each_stage, stage_constants, stage_product
from dq_marine.algebra.vector3 import Vector3, dot
from dq_marine.integrator.collocation import Collocation, half_matrix
from dq_marine.integrator.galerkin_curve import (
    attitude_from,
    first_momentum,
    is_plain,
    make_first_node,
    travelled,
    turning_from,
)
from dq_marine.integrator.galerkin_forced_curve import (
    Flight,
    ForcedNode,
    ForcesAlong,
    Motion,
    make_forced_node,
    motion_with,
)

FREE_SWEEPS = 3
STEADY_SWEEPS, FORCED_SWEEPS = 2, 2
"""With the forces at the start, and with those on the way."""


def kirchhoff_rate(momentum: Spatial, twist: Spatial, wrench: Spatial) -> Spatial:
    """Return mu' of Kirchhoff's equations under a wrench."""
    return spatial_add(momentum_bracket(twist, momentum), wrench)


def momentum_and_twist(inverse: Matrix6, start: Spatial, change: Spatial) -> tuple[Spatial, Spatial]:
    """Return mu and M^-1 mu, where the momentum has changed since the start."""
    there = spatial_add(start, change)
    return there, matrix6_transform(inverse, there)


def make_steady_start(method: Collocation) -> Callable[[Matrix6, Spatial, Spatial], Any]:
    """Return (M^-1, momentum at the start, its rate there) -> (momenta, twists, Gamma) at the nodes, to first order."""
    weights, nodes = method.weights, method.nodes

    def steady_start(inverse: Matrix6, start: Spatial, slope: Spatial) -> Any:
        change = each_stage(weights, spatial_scale, (stage_constants(nodes, start.angular[0]), slope))
        there, twist = each_stage(weights, momentum_and_twist, (inverse, start, change))
        return there, twist, each_stage(weights, quaternion_from_vector, (twist.angular,))

    return steady_start


def make_kirchhoff_sweep(method: Collocation) -> Callable[[Matrix6, Spatial, Any, Any], Any]:
    """Return (M^-1, momentum at the start, its rates and Gamma at the nodes) -> (momenta, twists, Gamma) there (V9)."""
    weights, matrix, halved = method.weights, method.matrix, half_matrix(method)

    def kirchhoff_sweep(inverse: Matrix6, start: Spatial, rates: Spatial, turning: Quaternion) -> Any:
        change = stage_product(matrix, rates)
        there, twist = each_stage(weights, momentum_and_twist, (inverse, start, change))
        turn = stage_product(halved, turning)
        return there, twist, each_stage(weights, turning_from, (turn, twist.angular))

    return kirchhoff_sweep


def make_first_nodes(method: Collocation) -> Callable[[Matrix6, Spatial], Any]:
    """Return (M^-1, scaled momenta at the start) -> the nodes of a free step."""
    weights, matrix, halved = method.weights, method.matrix, half_matrix(method)
    steady_start, kirchhoff_sweep = make_steady_start(method), make_kirchhoff_sweep(method)
    first_node = make_first_node(len(weights))

    def first_nodes(inverse: Matrix6, start: Spatial) -> Any:
        slope = momentum_bracket(matrix6_transform(inverse, start), start)
        there, twist, turning = steady_start(inverse, start, slope)
        for _ in range(FREE_SWEEPS):
            rates = each_stage(weights, momentum_bracket, (twist, there))
            there, twist, turning = kirchhoff_sweep(inverse, start, rates, turning)
        sigma = stage_product(matrix, each_stage(weights, dot, (there.angular, twist.angular)))
        guess = (inverse, start.linear, stage_product(halved, turning), there.angular, sigma)
        return each_stage(weights, first_node, guess)

    return first_nodes


def unit_from(turn: Quaternion) -> Quaternion:
    """Return gamma, made unit, from half the sum of Gamma (V1)."""
    gamma = attitude_from(turn)
    return quaternion_scale(1.0 / math.sqrt(quaternion_dot(gamma, gamma)), gamma)


def velocity_along(turn: Quaternion, velocity: Vector3) -> Vector3:
    """Return R v, from half the sum of Gamma."""
    return travelled(attitude_from(turn), velocity)


def make_first_motion(stages: int) -> Callable[[Spatial, Spatial, Quaternion, float], Motion]:
    """Return (momentum, twist, half the sum of Gamma, the sum of a . omega) -> the motion at a node, nearly."""
    plain = is_plain(stages)

    def first_motion(there: Spatial, twist: Spatial, turn: Quaternion, sigma: float) -> Motion:
        gamma = attitude_from(turn)
        gain = 1.0 / quaternion_dot(gamma, gamma)
        return motion_with(
            plain, gain, gamma, first_momentum(plain, there.angular, sigma, there.linear), twist
        )

    return first_motion


def make_first_forced_nodes(
    method: Collocation, forces_along: ForcesAlong
) -> Callable[[Flight, Spatial, Spatial], ForcedNode]:
    """Return (flight, twist at the start, wrench there times h^2) -> the nodes of a step under forces."""
    weights, nodes, matrix, halved = method.weights, method.nodes, method.matrix, half_matrix(method)
    steady_start, kirchhoff_sweep = make_steady_start(method), make_kirchhoff_sweep(method)
    first_motion, forced_node = make_first_motion(len(weights)), make_forced_node(len(weights), forces_along)

    def on_the_way(flight: Flight, parts: Any, twist: Spatial, turning: Quaternion) -> Any:
        turn = stage_product(halved, turning)
        way = stage_product(matrix, each_stage(weights, velocity_along, (turn, twist.linear)))
        units = each_stage(weights, unit_from, (turn,))
        return each_stage(weights, forces_along, (flight, parts, twist, units, way))

    def first_forced_nodes(flight: Flight, twist_there: Spatial, acting: Spatial) -> Any:
        inverse, start = flight.parameters.inertia.inverse, flight.start
        parts = stage_constants(nodes, start.angular[0])
        slope = kirchhoff_rate(start, twist_there, acting)
        there, twist, turning = steady_start(inverse, start, slope)
        for _ in range(STEADY_SWEEPS):
            rates = each_stage(weights, kirchhoff_rate, (there, twist, acting))
            there, twist, turning = kirchhoff_sweep(inverse, start, rates, turning)
        for _ in range(FORCED_SWEEPS):
            wrenches = on_the_way(flight, parts, twist, turning)
            rates = each_stage(weights, kirchhoff_rate, (there, twist, wrenches))
            there, twist, turning = kirchhoff_sweep(inverse, start, rates, turning)
        sigma = stage_product(matrix, each_stage(weights, dot, (there.angular, twist.angular)))
        turn = stage_product(halved, turning)
        motion = each_stage(weights, first_motion, (there, twist, turn, sigma))
        way = stage_product(halved, motion.travelling)
        return each_stage(weights, forced_node, (flight, parts, motion, turn, way))

    return first_forced_nodes
