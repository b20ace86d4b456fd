"""The curve of a Galerkin step at one of its nodes.

Within a step the pose, seen from where the step starts, is the rotation of a quaternion gamma and the displacement x,
both polynomials of degree s in the time, whose rates at the s Gauss nodes make the action stationary. In units in
which the step lasts 1, with (a, b) = h mu the scaled momenta at the start, Gamma = 2 gamma', pi half the momentum of
gamma and Pi = 2 pi', A and w Gauss's matrix and weights, (m, f) the wrench times h^2 (docs/theory.md, "The Galerkin
step"):

    gamma_j = 1 + (1/2) sum_i A_ji Gamma_i,   pi_j = a + (1/2) sum_i A_ji Pi_i                          (V1)
    b_j = R_j^T (b + sum_i A_ji R_i f_i),     a_j = Im(gamma_j* pi_j)                                   (V2)
    (omega_j, v_j) = M^-1 (a_j, b_j)                                                                    (V3)
    Gamma_j = gamma_j omega_j,   Pi_j = pi_j omega_j + 2 gamma_j (b_j x v_j + m_j)/|gamma_j|^2          (V4)
    x_j = sum_i A_ji R_i v_i                                                                            (V5)

Vectors stand for pure quaternions. R_j is the rotation of gamma_j, whose length differs from 1 inside the step by what
a polynomial cannot follow; at the step's end it is 1.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_add,
    quaternion_dot,
    quaternion_scale,
    quaternion_subtract,
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


def multiply_vector(q: Quaternion, a: Vector3) -> Quaternion:
    """Return q (0, a)."""
    axis = (q[1], q[2], q[3])
    part = add_scaled(cross(axis, a), q[0], a)
    return (-dot(axis, a), part[0], part[1], part[2])


def conjugate_product_vector(q: Quaternion, p: Quaternion) -> Vector3:
    """Return Im(q* p)."""
    axis, other = (q[1], q[2], q[3]), (p[1], p[2], p[3])
    return subtract(subtract(scale(q[0], other), scale(p[0], axis)), cross(axis, other))


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


def momentum_from(a: Vector3, half_sum: Quaternion) -> Quaternion:
    """Return pi from half the sum of Pi (V1)."""
    return (half_sum[0], a[0] + half_sum[1], a[1] + half_sum[2], a[2] + half_sum[3])


def node_of(inverse: Matrix6, b: Vector3, gamma: Quaternion, pi: Quaternion) -> Node:
    """Return the node of a free step at gamma and pi."""
    twice_gain = 2.0 / quaternion_dot(gamma, gamma)
    linear = turned_back(gamma, twice_gain, b)
    twist = matrix6_transform(inverse, Spatial(conjugate_product_vector(gamma, pi), linear))  # (V2), (V3)
    moment = scale(twice_gain, cross(linear, twist.linear))
    forcing = quaternion_add(multiply_vector(pi, twist.angular), multiply_vector(gamma, moment))  # (V4)
    return Node(Rates(multiply_vector(gamma, twist.angular), forcing), gamma, twist.linear)


def node_at(inverse: Matrix6, start: Spatial, half_sums: Rates) -> Node:
    """Return the node of a free step from the scaled momenta at its start and half the sums of the rates."""
    gamma = attitude_from(half_sums.turning)  # (V1)
    return node_of(inverse, start.linear, gamma, momentum_from(start.angular, half_sums.forcing))


def first_node(inverse: Matrix6, b: Vector3, half_sum: Quaternion, a: Vector3) -> Node:
    """Return a first guess of a node, from half the sum of Gamma and the angular momentum a_j in the body frame."""
    gamma = attitude_from(half_sum)
    gain = 1.0 / quaternion_dot(gamma, gamma)
    return node_of(inverse, b, gamma, quaternion_scale(gain, multiply_vector(gamma, a)))


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
