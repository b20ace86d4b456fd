"""A Lie group variational integrator on SO(3) x R^3: rotation and translation each for itself, coupled by forces.

In the manner of the Lie group variational integrators of rigid and underwater bodies (Lee, Leok, McClamroch 2007,
Comput. Methods Appl. Mech. Eng. 196, 2907; Nordkvist, Sanyal 2010, 49th IEEE CDC, 5414): rotation by Moser and
Veselov's discrete top, position by Verlet's method, and what couples them as explicit forces. With the blocks of
M^-1 = [A, B; B^T, C] the Hamiltonian splits into the top (1/2) Pi.A Pi, the translation (1/2) p.C p and, if M12 is not
zero, the coupling Pi.B p. A step is K(h/2) T(h/2) F(h) T(h/2) K(h/2), explicit but for F:

    K   at frozen pose: mu += h times all forces, at a mean velocity where they depend on it
    T   at frozen attitude: v = C p + B^T Pi,   l += h R v,   Pi += h p x v      (Munk's moment as an explicit force)
    F   at frozen position: Jc + c x Jc = (1 + c.c) a,  J = A^-1,  a = (h/2) (Pi - g),  the turn (1, c)/sqrt(1 + c.c);
        Pi and p are turned back by it                                                       (Moser and Veselov)

g = M12 M22^-1 p is the angular momentum that the translation carries, taken explicitly for the middle of the step. For
M12 = 0 the step is variational: symplectic, time-symmetric and of order 2. With M12 it is still of order 2, but no
longer symplectic. Without forces the spatial momentum is exact either way. The published methods have no M12; to lag it
by a step, as one does with a force that is at hand, would be of order 1.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import pose_from_parts, pose_position
from dq_marine.algebra.matrix3 import (
    Matrix3,
    invert,
    matrix_multiply,
    transform,
)
from dq_marine.algebra.quaternion import Quaternion, quaternion_multiply, rotate, rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale, subtract
from dq_marine.integrator.body import BodyState
from dq_marine.integrator.forces import make_forced_kick
from dq_marine.integrator.inertia import Inertia
from dq_marine.integrator.kick import UndampedKick, undamped_kick
from dq_marine.integrator.step import Advance, Composition, StepOutcome, StepParameters
from dq_marine.report.baselines.dynamics import Point, make_landing
from dq_marine.report.baselines.normalisation import normalised

MAX_ITERATIONS = 12
CONVERGED = 1e-16
"""Of Newton's squared correction, relative: its error is the correction's square, hence round-off."""


class Top(NamedTuple):
    """The rotating part: J = A^-1, A, and G = M12 M22^-1, which makes g of p."""

    inertia: Matrix3
    inverse: Matrix3
    gain: Matrix3


class Turn(NamedTuple):
    """Newton's solution: the Cayley vector c of the step, and the iterations it took."""

    vector: Vector3
    iterations: int


def top_of(inertia: Inertia) -> Top:
    """Return the rotating part of a body."""
    inverse = inertia.inverse.angular
    gain = matrix_multiply(inertia.matrix.angular_linear, inertia.linear_block_inverse)
    return Top(invert(inverse), inverse, gain)


def residual(a: Vector3, c: Vector3, jc: Vector3) -> Vector3:
    """Return Jc + c x Jc - (1 + c.c) a."""
    return add_scaled(add(jc, cross(c, jc)), -(1.0 + dot(c, c)), a)


def jacobian(j: Matrix3, a: Vector3, c: Vector3, jc: Vector3) -> Matrix3:
    """Return the residual's derivative with respect to c, J + S(c) J - S(Jc) - 2 a c^T."""
    x, y, z = c
    turned_j = matrix_multiply((1.0, -z, y, z, 1.0, -x, -y, x, 1.0), j)
    u, v, w = 2.0 * a[0], 2.0 * a[1], 2.0 * a[2]
    return (
        turned_j[0] - u * x,
        turned_j[1] + jc[2] - u * y,
        turned_j[2] - jc[1] - u * z,
        turned_j[3] - jc[2] - v * x,
        turned_j[4] - v * y,
        turned_j[5] + jc[0] - v * z,
        turned_j[6] + jc[1] - w * x,
        turned_j[7] - jc[0] - w * y,
        turned_j[8] - w * z,
    )


def solve_turn(top: Top, a: Vector3) -> Turn:
    """Return the c that solves (F), from c = A a on."""
    c = transform(top.inverse, a)
    iterations = 0
    for _ in range(MAX_ITERATIONS):
        jc = transform(top.inertia, c)
        step = transform(invert(jacobian(top.inertia, a, c, jc)), residual(a, c, jc))
        c = subtract(c, step)
        iterations += 1
        if not dot(step, step) > CONVERGED * dot(c, c):
            break
    return Turn(c, iterations)


def coupled_momentum(top: Top, h: float, momentum: Spatial) -> Vector3:
    """Return Pi - g, g as it is in the middle of the step, in the frame at its start, to first order in h."""
    carried = transform(top.gain, momentum.linear)
    spin = transform(top.inverse, subtract(momentum.angular, carried))
    swept = subtract(cross(spin, carried), transform(top.gain, cross(spin, momentum.linear)))
    return subtract(momentum.angular, add_scaled(carried, 0.5 * h, swept))


def translate(inertia: Inertia, h: float, point: Point) -> Point:
    """Return the body after T; Pi in v at the middle, by a half step."""
    linear = point.momentum.linear
    inverse = inertia.inverse
    own = transform(inverse.linear, linear)
    first = add(own, transform(inverse.linear_angular, point.momentum.angular))
    middle = add_scaled(point.momentum.angular, 0.5 * h, cross(linear, first))
    velocity = add(own, transform(inverse.linear_angular, middle))
    return Point(
        point.attitude,
        add_scaled(point.position, h, rotate(point.attitude, velocity)),
        Spatial(add_scaled(point.momentum.angular, h, cross(linear, velocity)), linear),
    )


def turn_point(point: Point, c: Vector3) -> Point:
    """Return the body turned by the Cayley vector c at frozen position, its momentum kept in the world."""
    turn: Quaternion = normalised((1.0, c[0], c[1], c[2]))
    momentum = Spatial(
        rotate_inverse(turn, point.momentum.angular), rotate_inverse(turn, point.momentum.linear)
    )
    return Point(normalised(quaternion_multiply(point.attitude, turn)), point.position, momentum)


def make_decoupled_lie(composition: Composition) -> Advance:
    """Return the advance of the decoupled integrator.

    One evaluation of the pose forces a step, and two of the velocity forces; the kicks between two steps are taken
    together.
    """
    kick = make_forced_kick(undamped_kick, composition.forces)
    carry = composition.water.at_stages.carry
    land = make_landing(composition)

    def kicked(
        parameters: StepParameters, h: float, point: Point, start: float, elapsed: float, wrench: Spatial
    ) -> Point:
        pose = carry(parameters.water, start, elapsed, pose_from_parts(point.attitude, point.position))
        momentum = kick(
            parameters.forces,
            (),
            parameters.inertia,
            UndampedKick(h),
            pose,
            point.momentum,
            start + elapsed,
            wrench,
        )
        return Point(point.attitude, point.position, momentum)

    def decoupled_lie(
        parameters: StepParameters, state: BodyState, wrench: Spatial, time: float, steps: int
    ) -> StepOutcome:
        h, inertia = parameters.timing.h, parameters.inertia
        half = 0.5 * h
        top = top_of(inertia)
        iterations = 0
        point = Point(state.pose.real, pose_position(state.pose), state.momentum)
        point = kicked(parameters, half, point, time, 0.0, wrench)
        for step in range(steps):
            point = translate(inertia, half, point)
            solved = solve_turn(top, scale(half, coupled_momentum(top, h, point.momentum)))
            iterations += solved.iterations
            point = translate(inertia, half, turn_point(point, solved.vector))
            following = half if step == steps - 1 else h
            point = kicked(parameters, following, point, time, (step + 1) * h, wrench)
        return land(parameters, state, point, time, steps, iterations)

    return decoupled_lie
