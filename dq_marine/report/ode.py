"""The equations of motion as an ordinary differential equation, written separately from the step.

Fossen's form (Fossen 2021, eqs. 6.111 to 6.116, C from M by Theorem 3.2), with a quaternion:

    l' = R nu1 + v_c,   q' = (1/2) q (0, nu2),   M nu' = tau - C(nu) nu - D(nu) nu - g(q),   nu relative to the water

The state is y = (l, q, nu), shape (13,). Nothing is shared with the step but the functions of forces that are neither
restoring nor damping: those are the physics' own. References come from here, so this is written to be seen right; what
is timed against the product is compiled (`report.libraries`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import Spatial
from dq_marine.report.end_state import EndState
from dq_marine.report.physics import Physics

Array = NDArray[np.float64]
Derivative: TypeAlias = Callable[[float, Array], Array]


def make_derivative(physics: Physics, wrench: Array) -> Derivative:
    """Return (t, y) -> y' under a constant body wrench, shape (6,) in Fossen's order."""
    inverse = np.linalg.inv(physics.mass_matrix)
    others = make_other_forces(physics)

    def derivative(time: float, y: Array) -> Array:
        q, nu = y[3:7], y[7:]
        rotation = rotation_matrix(q)
        force = wrench + restoring(physics, rotation) - coriolis(physics.mass_matrix, nu) @ nu
        force = force - physics.linear @ nu - physics.quadratic * np.abs(nu) * nu
        force = force + others(time, y)
        travel = rotation @ nu[:3] + physics.current_ned
        return np.concatenate([travel, quaternion_rate(q, nu[3:]), inverse @ force])

    return derivative


def start_of(physics: Physics, position: Array, quaternion: Array, velocity: Array) -> Array:
    """Return y of a body with a velocity over ground."""
    through_water = velocity.copy()
    through_water[:3] -= rotation_matrix(quaternion).T @ physics.current_ned
    return np.concatenate([position, quaternion, through_water])


def end_state(physics: Physics, y: Array) -> EndState:
    """Return what y stands for, the quaternion made unit and the velocity over ground."""
    q = y[3:7] / np.linalg.norm(y[3:7])
    velocity = y[7:].copy()
    velocity[:3] += rotation_matrix(q).T @ physics.current_ned
    return EndState(y[:3].copy(), q, velocity)


def rotation_matrix(q: Array) -> Array:
    """Return R of a quaternion of any length."""
    w, x, y, z = (q / np.sqrt(q @ q)).tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_rate(q: Array, spin: Array) -> Array:
    """Return (1/2) q (0, spin)."""
    w, x, y, z = q.tolist()
    a, b, c = spin.tolist()
    return 0.5 * np.array(
        [-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
    )


def coriolis(m: Array, nu: Array) -> Array:
    """Return C(nu) from M, skew-symmetric, shape (6, 6)."""
    a, b, c, d, e, f = (m @ nu).tolist()
    return np.array(
        [
            [0.0, 0.0, 0.0, 0.0, c, -b],
            [0.0, 0.0, 0.0, -c, 0.0, a],
            [0.0, 0.0, 0.0, b, -a, 0.0],
            [0.0, c, -b, 0.0, f, -e],
            [-c, 0.0, a, -f, 0.0, d],
            [b, -a, 0.0, e, -d, 0.0],
        ]
    )


def restoring(physics: Physics, rotation: Array) -> Array:
    """Return -g: net weight and righting moment, shape (6,)."""
    x, y, z = rotation[2].tolist()  # the direction of down, in the body frame
    a, b, c = physics.arm.tolist()
    weight = physics.excess_weight
    return np.array([weight * x, weight * y, weight * z, b * z - c * y, c * x - a * z, a * y - b * x])


def make_other_forces(physics: Physics) -> Callable[[float, Array], Array]:
    """Return (t, y) -> the sum of the physics' own forces, shape (6,)."""
    if not physics.forces:
        return lambda time, y: np.zeros(6)

    def others(time: float, y: Array) -> Array:
        length = float(np.sqrt(y[3:7] @ y[3:7]))
        attitude, position = tuple((y[3:7] / length).tolist()), tuple(y[:3].tolist())
        pose: Any = pose_from_parts(attitude, position)
        twist = Spatial(tuple(y[10:].tolist()), tuple(y[7:10].tolist()))
        total = np.zeros(6)
        for force in physics.forces:
            wrench = force.wrench_at(pose, twist, time)
            total += np.array([*wrench.linear, *wrench.angular])
        return total

    return others
