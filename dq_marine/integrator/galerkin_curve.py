"""The curve of a Galerkin step at one of its nodes.

Within a step the pose, seen from where the step starts, is the rotation of a quaternion gamma and the displacement x,
both polynomials of degree s in the time, whose rates at the s Gauss nodes make the action stationary. In units in
which the step lasts 1, with (a, b) = h mu the scaled momenta at the start, Gamma = 2 gamma', pi half the momentum of
gamma and Pi = 2 pi', A and w Gauss's matrix and weights, (m, f) the wrench times h^2 (docs/theory.md, "The Galerkin
step"):

    gamma_j = 1 + (1/2) sum_i A_ji Gamma_i,   pi_j = a + (1/2) sum_i A_ji Pi_i                          (V1)
    b_j = R_j^T (b + sum_i A_ji R_i f_i),     sigma_j + a_j = gamma_j^-1 pi_j                           (V2)
    (omega_j, v_j) = M^-1 (a_j, b_j)                                                                    (V3)
    Gamma_j = e_j omega_j,   Pi_j = e_j (a_j . omega_j + a_j x omega_j + sigma_j omega_j + 2 (b_j x v_j + m_j)),
    e_j = gamma_j/|gamma_j|^2                                                                           (V4)
    x_j = sum_i A_ji R_i v_i                                                                            (V5)

Vectors stand for pure quaternions, and numbers for real ones: sigma_j is the real part of gamma_j^-1 pi_j. R_j is the
rotation of gamma_j, whose length differs from 1 inside the step by what a polynomial cannot follow; at the step's end
it is 1. With one node, e_j = gamma_j and

    sigma_1 + a_1 = gamma_1* pi_1,   Pi_1 = (gamma_1/|gamma_1|^2) (-a_1 . omega_1 + a_1 x omega_1 + ...)    (V4)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_conjugate,
    quaternion_dot,
    quaternion_multiply,
    quaternion_renormalise,
    quaternion_scale,
    quaternion_subtract,
    quaternion_vector,
)
from dq_marine.algebra.spatial import Matrix6, Spatial, matrix6_transform
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale, subtract


class Rates(NamedTuple):
    """Gamma and Pi at a node (V4)."""

    turning: Quaternion
    forcing: Quaternion


class Node(NamedTuple):
    """A node of a free step: its rates, gamma, and the linear velocity v in the body frame."""

    rates: Rates
    attitude: Quaternion
    velocity: Vector3


class Momentum(NamedTuple):
    """At a node: gamma^-1 pi, whose vector part is the angular momentum a in the body frame, and the linear one, b."""

    turning: Quaternion
    linear: Vector3


def multiply_vector(q: Quaternion, a: Vector3) -> Quaternion:
    """Return q (0, a)."""
    axis = (q[1], q[2], q[3])
    part = add_scaled(cross(axis, a), q[0], a)
    return (-dot(axis, a), part[0], part[1], part[2])


def turned(q: Quaternion, twice_gain: float, a: Vector3) -> Vector3:
    """Return R a for a q of any length, with 2/|q|^2."""
    axis = (q[1], q[2], q[3])
    across = cross(axis, a)
    return add_scaled(a, twice_gain, add(cross(axis, across), scale(q[0], across)))


def turned_back(q: Quaternion, twice_gain: float, a: Vector3) -> Vector3:
    """Return R^T a for a q of any length, with 2/|q|^2."""
    axis = (q[1], q[2], q[3])
    across = cross(axis, a)
    return add_scaled(a, twice_gain, subtract(cross(axis, across), scale(q[0], across)))


def attitude_from(half_sum: Quaternion) -> Quaternion:
    """Return gamma from half the sum of Gamma (V1)."""
    return (1.0 + half_sum[0], half_sum[1], half_sum[2], half_sum[3])


def last_attitude_from(half_sum: Quaternion) -> Quaternion:
    """Return gamma at the step's end from half the sum of Gamma, (V6), whose length is 1.

    What the sweeps leave of that is round-off, but of one sign, which would add up over many steps: it is removed.
    """
    return quaternion_renormalise(attitude_from(half_sum))


def momentum_from(a: Vector3, half_sum: Quaternion) -> Quaternion:
    """Return pi from half the sum of Pi (V1)."""
    return (half_sum[0], a[0] + half_sum[1], a[1] + half_sum[2], a[2] + half_sum[3])


def is_plain(stages: int) -> bool:
    """Whether e is gamma (V4): with one node, so that the step is the midpoint scheme's, and with two."""
    return stages < 3


def outward(plain: bool, gain: float, gamma: Quaternion) -> Quaternion:
    """Return e (V4), with 1/|gamma|^2."""
    return gamma if plain else quaternion_scale(gain, gamma)


def rates_of(
    plain: bool, gain: float, e: Quaternion, momentum: Momentum, twist: Spatial, moment: Vector3
) -> Rates:
    """Return the rates at a node (V4), with 1/|gamma|^2, from twice the moment b x v + m there."""
    omega, turning = twist.angular, momentum.turning
    a = quaternion_vector(turning)
    power = dot(a, omega)
    across = add(add_scaled(cross(a, omega), turning[0], omega), moment)
    forcing = quaternion_multiply(e, (-power if plain else power, across[0], across[1], across[2]))
    return Rates(multiply_vector(e, omega), quaternion_scale(gain, forcing) if plain else forcing)


def momentum_at(plain: bool, gain: float, gamma: Quaternion, pi: Quaternion, linear: Vector3) -> Momentum:
    """Return the momentum in the body frame (V2), with 1/|gamma|^2, from the linear one in the step's first frame."""
    turning = quaternion_multiply(quaternion_conjugate(gamma), pi)
    return Momentum(
        turning if plain else quaternion_scale(gain, turning), turned_back(gamma, gain + gain, linear)
    )


def twist_at(inverse: Matrix6, momentum: Momentum) -> Spatial:
    """Return (omega, v) at a node (V3)."""
    return matrix6_transform(inverse, Spatial(quaternion_vector(momentum.turning), momentum.linear))


def node_of(plain: bool, inverse: Matrix6, gamma: Quaternion, gain: float, momentum: Momentum) -> Node:
    """Return the node of a free step at gamma, with 1/|gamma|^2, where the momentum is known."""
    twist = twist_at(inverse, momentum)
    moment = cross(momentum.linear, twist.linear)
    e = outward(plain, gain, gamma)
    return Node(rates_of(plain, gain, e, momentum, twist, add(moment, moment)), gamma, twist.linear)


def make_node_at(stages: int) -> Callable[[Matrix6, Spatial, Rates], Node]:
    """Return (M^-1, scaled momenta at the start, half the sums of the rates) -> a node of a free step."""
    plain = is_plain(stages)

    def node_at(inverse: Matrix6, start: Spatial, half_sums: Rates) -> Node:
        gamma = attitude_from(half_sums.turning)  # (V1)
        pi = momentum_from(start.angular, half_sums.forcing)
        gain = 1.0 / quaternion_dot(gamma, gamma)
        return node_of(plain, inverse, gamma, gain, momentum_at(plain, gain, gamma, pi, start.linear))

    return node_at


def first_momentum(plain: bool, a: Vector3, sigma: float, b: Vector3) -> Momentum:
    """Return a first guess of the momentum at a node from the angular and the linear one in the body frame.

    `sigma` is the sum of a . omega, which sigma comes to but for one or two nodes.
    """
    return Momentum((0.0 * sigma if plain else sigma, a[0], a[1], a[2]), b)


def make_first_node(stages: int) -> Callable[[Matrix6, Vector3, Quaternion, Vector3, float], Node]:
    """Return (M^-1, b at the start, half the sum of Gamma, a, the sum of a . omega) -> a first guess of a node.

    a is the angular momentum in the body frame.
    """
    plain = is_plain(stages)

    def first_node(inverse: Matrix6, b: Vector3, half_sum: Quaternion, a: Vector3, sigma: float) -> Node:
        gamma = attitude_from(half_sum)
        gain = 1.0 / quaternion_dot(gamma, gamma)
        momentum = first_momentum(plain, a, sigma, turned_back(gamma, gain + gain, b))
        return node_of(plain, inverse, gamma, gain, momentum)

    return first_node


def travelled(gamma: Quaternion, velocity: Vector3) -> Vector3:
    """Return R v, the velocity in the frame of the step's start."""
    return turned(gamma, 2.0 / quaternion_dot(gamma, gamma), velocity)


def turning_from(half_sum: Quaternion, omega: Vector3) -> Quaternion:
    """Return Gamma from half the sum of an earlier Gamma and the angular velocity."""
    return multiply_vector(attitude_from(half_sum), omega)


def change_squared(a: Quaternion, b: Quaternion) -> float:
    """Return |a - b|^2."""
    d = quaternion_subtract(a, b)
    return quaternion_dot(d, d)
