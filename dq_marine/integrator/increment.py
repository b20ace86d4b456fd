"""Increments of the pose: how they follow from a twist that changes during a step, and how they are joined."""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_add,
    quaternion_conjugate,
    quaternion_dot,
    quaternion_from_vector,
    quaternion_multiply,
    quaternion_renormalise,
    quaternion_scale,
    rotate_inverse,
)
from dq_marine.algebra.selection import by_precision, smallest_normal
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale, subtract

SINGULAR = 1e-9
"""Of a momentum's squared size: below this a correction of the pose that leaves it as it is has no say."""

SINGULAR_SINGLE = 1e-4
"""`SINGULAR` where numbers have single precision."""


class Increment(NamedTuple):
    """A motion of the body frame: its unit rotation, and its displacement in the frame that it leads to [m]."""

    rotation: Quaternion
    shift: Vector3


AT_ONCE = Increment((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""No motion."""


class QuadraticTwist(NamedTuple):
    """A twist as a quadratic in the time from the middle of a step, in half steps; per half step."""

    constant: Spatial
    linear: Spatial
    square: Spatial


class Twists(NamedTuple):
    """A twist as a cubic in the time from the middle of a step, in half steps; per half step."""

    constant: Spatial
    linear: Spatial
    square: Spatial
    cube: Spatial


def unit(q: Quaternion) -> Quaternion:
    """Return q / |q|; zero for zero, which is left of a rotation that overflowed."""
    return quaternion_scale(1.0 / math.sqrt(quaternion_dot(q, q) + smallest_normal(q[0])), q)


def turned(p: Quaternion, w: Vector3) -> Quaternion:
    """Return p (0, w)."""
    return (
        -(p[1] * w[0] + p[2] * w[1] + p[3] * w[2]),
        p[0] * w[0] + p[2] * w[2] - p[3] * w[1],
        p[0] * w[1] + p[3] * w[0] - p[1] * w[2],
        p[0] * w[2] + p[1] * w[1] - p[2] * w[0],
    )


def turned_by_four(
    p: Quaternion, u: Vector3, q: Quaternion, v: Vector3, r: Quaternion, w: Vector3, s: Quaternion, x: Vector3
) -> Quaternion:
    """Return p (0, u) + q (0, v) + r (0, w) + s (0, x)."""
    return quaternion_add(
        quaternion_add(turned(p, u), turned(q, v)), quaternion_add(turned(r, w), turned(s, x))
    )


def turned_by_three(
    p: Quaternion, u: Vector3, q: Quaternion, v: Vector3, r: Quaternion, w: Vector3
) -> Quaternion:
    """Return p (0, u) + q (0, v) + r (0, w)."""
    return quaternion_add(quaternion_add(turned(p, u), turned(q, v)), turned(r, w))


def crossed_by_three(a: Vector3, u: Vector3, b: Vector3, v: Vector3, c: Vector3, w: Vector3) -> Vector3:
    """Return a x u + b x v + c x w."""
    return add(add(cross(a, u), cross(b, v)), cross(c, w))


def crossed_by_four(
    a: Vector3, u: Vector3, b: Vector3, v: Vector3, c: Vector3, w: Vector3, d: Vector3, x: Vector3
) -> Vector3:
    """Return a x u + b x v + c x w + d x x."""
    return add(add(cross(a, u), cross(b, v)), add(cross(c, w), cross(d, x)))


def half_turns(twists: Twists) -> tuple[Quaternion, Quaternion]:
    """Return the even and the odd part of the rotation from the middle of a step.

    The series of P' = (1/2) P (0, omega), (k + 1) P_k+1 = sum_i P_i (0, omega_k-i / 2), P_0 = 1, to degree 7 (G4).
    """
    h0, h1 = scale(0.5, twists.constant.angular), scale(0.5, twists.linear.angular)
    h2, h3 = scale(0.5, twists.square.angular), scale(0.5, twists.cube.angular)
    p1 = quaternion_from_vector(h0)
    p2 = quaternion_scale(0.5, (-dot(h0, h0), h1[0], h1[1], h1[2]))
    third = quaternion_add(quaternion_add(turned(p2, h0), turned(p1, h1)), quaternion_from_vector(h2))
    p3 = quaternion_scale(1.0 / 3.0, third)
    fourth = quaternion_add(quaternion_add(turned(p3, h0), turned(p2, h1)), turned(p1, h2))
    p4 = quaternion_scale(0.25, quaternion_add(fourth, quaternion_from_vector(h3)))
    p5 = quaternion_scale(0.2, turned_by_four(p4, h0, p3, h1, p2, h2, p1, h3))
    p6 = quaternion_scale(1.0 / 6.0, turned_by_four(p5, h0, p4, h1, p3, h2, p2, h3))
    p7 = quaternion_scale(1.0 / 7.0, turned_by_four(p6, h0, p5, h1, p4, h2, p3, h3))
    even = quaternion_add(quaternion_add(p2, p4), p6)
    odd = quaternion_add(quaternion_add(p1, p3), quaternion_add(p5, p7))
    return (1.0 + even[0], even[1], even[2], even[3]), odd


def half_shifts(twists: Twists) -> tuple[Vector3, Vector3]:
    """Return the even and the odd part of the displacement from the middle of a step, in the frame that is reached.

    The series of S' = v + S x omega, (k + 1) S_k+1 = v_k + sum_i S_i x omega_k-i, S_0 = 0, to degree 7 (G5).
    """
    w0, w1, w2, w3 = (
        twists.constant.angular,
        twists.linear.angular,
        twists.square.angular,
        twists.cube.angular,
    )
    s1 = twists.constant.linear
    s2 = scale(0.5, add(twists.linear.linear, cross(s1, w0)))
    s3 = scale(1.0 / 3.0, add(twists.square.linear, add(cross(s2, w0), cross(s1, w1))))
    fourth = add(add(cross(s3, w0), cross(s2, w1)), cross(s1, w2))
    s4 = scale(0.25, add(twists.cube.linear, fourth))
    s5 = scale(0.2, crossed_by_four(s4, w0, s3, w1, s2, w2, s1, w3))
    s6 = scale(1.0 / 6.0, crossed_by_four(s5, w0, s4, w1, s3, w2, s2, w3))
    s7 = scale(1.0 / 7.0, crossed_by_four(s6, w0, s5, w1, s4, w2, s3, w3))
    return add(add(s2, s4), s6), add(add(s1, s3), add(s5, s7))


def half_turns_of_quadratic(twist: QuadraticTwist) -> tuple[Quaternion, Quaternion]:
    """Return the same as `half_turns` of a quadratic, to degree 6 (G4)."""
    h0, h1 = scale(0.5, twist.constant.angular), scale(0.5, twist.linear.angular)
    h2 = scale(0.5, twist.square.angular)
    p1 = quaternion_from_vector(h0)
    p2 = quaternion_scale(0.5, (-dot(h0, h0), h1[0], h1[1], h1[2]))
    third = quaternion_add(quaternion_add(turned(p2, h0), turned(p1, h1)), quaternion_from_vector(h2))
    p3 = quaternion_scale(1.0 / 3.0, third)
    p4 = quaternion_scale(0.25, turned_by_three(p3, h0, p2, h1, p1, h2))
    p5 = quaternion_scale(0.2, turned_by_three(p4, h0, p3, h1, p2, h2))
    p6 = quaternion_scale(1.0 / 6.0, turned_by_three(p5, h0, p4, h1, p3, h2))
    even = quaternion_add(quaternion_add(p2, p4), p6)
    return (1.0 + even[0], even[1], even[2], even[3]), quaternion_add(quaternion_add(p1, p3), p5)


def half_shifts_of_quadratic(twist: QuadraticTwist) -> tuple[Vector3, Vector3]:
    """Return the same as `half_shifts` of a quadratic, to degree 6 (G5)."""
    w0, w1, w2 = twist.constant.angular, twist.linear.angular, twist.square.angular
    s1 = twist.constant.linear
    s2 = scale(0.5, add(twist.linear.linear, cross(s1, w0)))
    s3 = scale(1.0 / 3.0, add(twist.square.linear, add(cross(s2, w0), cross(s1, w1))))
    s4 = scale(0.25, crossed_by_three(s3, w0, s2, w1, s1, w2))
    s5 = scale(0.2, crossed_by_three(s4, w0, s3, w1, s2, w2))
    s6 = scale(1.0 / 6.0, crossed_by_three(s5, w0, s4, w1, s3, w2))
    return add(add(s2, s4), s6), add(add(s1, s3), s5)


def increment_of_quadratic(twist: QuadraticTwist) -> Increment:
    """Return the motion of a whole step, from a quadratic."""
    even, odd = half_turns_of_quadratic(twist)
    even_shift, odd_shift = half_shifts_of_quadratic(twist)
    return both_halves(even, odd, even_shift, odd_shift)


def increment_of(twists: Twists) -> Increment:
    """Return the motion of a whole step, from a cubic."""
    even, odd = half_turns(twists)
    even_shift, odd_shift = half_shifts(twists)
    return both_halves(even, odd, even_shift, odd_shift)


def both_halves(even: Quaternion, odd: Quaternion, even_shift: Vector3, odd_shift: Vector3) -> Increment:
    """Return the motion from a step's start to its middle, and on to its end."""
    to_end = quaternion_add(even, odd)
    from_start = quaternion_conjugate(quaternion_add(even, quaternion_scale(-1.0, odd)))
    rotation = quaternion_multiply(from_start, to_end)
    rotation = unit(rotation)
    back = rotate_inverse(rotation, subtract(even_shift, odd_shift))
    return Increment(rotation, subtract(add(even_shift, odd_shift), back))


def carried(increment: Increment, momentum: Spatial) -> Spatial:
    """Return the body momentum after a free motion, by coadjoint transport: [R^T a - s x R^T b; R^T b]."""
    linear = rotate_inverse(increment.rotation, momentum.linear)
    angular = rotate_inverse(increment.rotation, momentum.angular)
    return Spatial(subtract(angular, cross(increment.shift, linear)), linear)


def consistent(length: float, increment: Increment, before: Spatial, after: Spatial) -> Increment:
    """Return the increment f exp(delta) with the smallest delta such that it carries one momentum to another (G6).

    With m the momentum that f carries to, ad*_delta m = after - m. In units of `length` the operator on delta is
    antisymmetric and has two singular values, S and d below their squares' sum and product, so its regularised
    inverse is a polynomial in it.
    """
    reached = carried(increment, before)
    a, b = reached.angular, scale(length, reached.linear)
    missing = Spatial(subtract(after.angular, a), subtract(scale(length, after.linear), b))
    level = Spatial(a, b)
    across = cross(a, b)
    linear_square = dot(b, b)
    both = dot(a, a) + 2.0 * linear_square
    product = linear_square * linear_square + dot(across, across)
    least = by_precision(both, SINGULAR, SINGULAR_SINGLE) * both
    once = bracket(level, missing)
    thrice = bracket(level, bracket(level, once))
    gain = -1.0 / (product + least * (both + least) + smallest_normal(both))
    turn = scale(gain, add_scaled(thrice.angular, both + least, once.angular))
    shift = scale(gain, add_scaled(thrice.linear, both + least, once.linear))
    return shifted(increment, turn, scale(length, shift))


def bracket(momentum: Spatial, delta: Spatial) -> Spatial:
    """Return ad*_delta momentum."""
    return momentum_bracket(delta, momentum)


def shifted(increment: Increment, turn: Vector3, shift: Vector3) -> Increment:
    """Return the increment followed by a small turn and shift in its frame."""
    rotation = quaternion_add(increment.rotation, turned(increment.rotation, scale(0.5, turn)))
    rotation = quaternion_scale(1.0 / math.sqrt(1.0 + 0.25 * dot(turn, turn)), rotation)
    return Increment(rotation, add(increment.shift, add(cross(increment.shift, turn), shift)))


def joined(first: Increment, second: Increment) -> Increment:
    """Return the motion that consists of two."""
    back = rotate_inverse(second.rotation, first.shift)
    return Increment(quaternion_multiply(first.rotation, second.rotation), add(back, second.shift))


def renormalised(increment: Increment) -> Increment:
    """Return the motion with a rotation of unit length.

    A product of many is off by round-off, mostly to one side. The momentum that it carries would shrink with it, and
    so would the energy, which is judged by that: by 1e-10 in a million steps.
    """
    return Increment(quaternion_renormalise(increment.rotation), increment.shift)


def as_pose(increment: Increment) -> DualQuaternion:
    """Return the increment as a unit dual quaternion q + eps (1/2) q s.

    The corrections (G6), (G10) leave a length that is off by round-off, again mostly to one side: it is removed.
    """
    rotation = quaternion_renormalise(increment.rotation)
    return DualQuaternion(rotation, quaternion_scale(0.5, turned(rotation, increment.shift)))
