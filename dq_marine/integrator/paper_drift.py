"""The force-free step of Xu & Halse (arXiv 1611.00616), its errata corrected and reduced to three unknowns.

The increment of a step is the unit dual quaternion f = (c, Phi) + eps (f0, Psi), and the vector parts stand for the
twist: T_d = (2/h) [Phi; Psi]^T M [Phi; Psi]. With a = (h/2) mu_angular, b = (h/2) mu_linear and
L = c 1 + S(Phi), c = sqrt(1 - Phi.Phi), stationarity of the discrete action reads (docs/theory.md, eqs. P1-P5)

    zb  = L^-1 b,   L^-1 = c 1 - S(Phi) + Phi Phi^T/c                                                   (P1)
    Psi = M22^-1 (zb - M21 Phi)                                                                         (P2)
    za  = M11 Phi + M12 Psi                                                                             (P3)
    f0  = -Psi.Phi/c                                                                                    (P4)
    L za + f0 zb + Psi x zb - a = 0                                                                     (P5)

The paper solves (P1) and (P5) together for six unknowns; eliminating Psi leaves the same solutions. For one axis
sin(step angle) = h omega: no solution for h omega > 1, and Phi beyond 1/sqrt(2) belongs to a spurious branch.
The scheme is not Galilean invariant: a free body moving along its spin axis turns wrongly, by a relative
h^2 m v^2/(4 J), and not at all for h v > 2 sqrt(J/m).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.matrix3 import Matrix3, matrix_from_columns, transform
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale, subtract
from dq_marine.integrator.drift import DriftScheme, make_drift, make_split_drift
from dq_marine.integrator.drift_report import equation_size_squared
from dq_marine.integrator.inertia import Inertia

SMALLEST_C_SQUARED = 0.5
"""Of the branch that starts at rest, whose step angles go up to 90 degrees."""


class PaperEquation(NamedTuple):
    """The discrete equation at one Phi: its terms (P1)-(P4) and its residual (P5)."""

    phi: Vector3
    c: float
    zb: Vector3
    psi: Vector3
    za: Vector3
    f0: float
    residual: Vector3
    relative_residual_squared: float


def turn(c: float, phi: Vector3, a: Vector3) -> Vector3:
    """Return L a = c a + Phi x a."""
    return add_scaled(cross(phi, a), c, a)


def turn_back(c: float, phi: Vector3, a: Vector3) -> Vector3:
    """Return L^-1 a = c a - Phi x a + Phi (Phi.a)/c."""
    return add_scaled(subtract(scale(c, a), cross(phi, a)), dot(phi, a) / c, phi)


def paper_equation(inertia: Inertia, phi: Vector3, a: Vector3, b: Vector3) -> PaperEquation:
    """Evaluate (P1)-(P5) at Phi."""
    c_squared = 1.0 - dot(phi, phi)
    # Beyond the branch that starts at rest c is held and the residual refused, so that the solver may come back.
    c = math.sqrt(max(c_squared, SMALLEST_C_SQUARED))
    zb = turn_back(c, phi, b)  # (P1)
    psi = transform(  # (P2)
        inertia.linear_block_inverse, subtract(zb, transform(inertia.matrix.linear_angular, phi))
    )
    coupled = transform(inertia.matrix.angular_linear, psi)
    za = add(transform(inertia.matrix.angular, phi), coupled)  # (P3)
    f0 = -dot(psi, phi) / c  # (P4)
    munk = add_scaled(cross(psi, zb), f0, zb)
    residual = subtract(add(turn(c, phi, za), munk), a)  # (P5)
    relative = dot(residual, residual) / equation_size_squared(a, za, munk, psi, zb, coupled)
    outside = select(c_squared < SMALLEST_C_SQUARED, 1.0, 0.0)
    return PaperEquation(phi, c, zb, psi, za, f0, residual, relative + outside)


def paper_derivative(inertia: Inertia, at: PaperEquation, dphi: Vector3) -> Vector3:
    """Return the derivative of the residual (P5) at `at` in the direction dphi."""
    phi, c = at.phi, at.c
    dc = -dot(phi, dphi) / c
    dzb = scale(-1.0, turn_back(c, phi, turn(dc, dphi, at.zb)))
    dpsi = transform(
        inertia.linear_block_inverse, subtract(dzb, transform(inertia.matrix.linear_angular, dphi))
    )
    dza = add(transform(inertia.matrix.angular, dphi), transform(inertia.matrix.angular_linear, dpsi))
    df0 = -(dot(dpsi, phi) + dot(at.psi, dphi) + at.f0 * dc) / c
    dmunk = add(cross(dpsi, at.zb), cross(at.psi, dzb))
    dmunk = add_scaled(add_scaled(dmunk, df0, at.zb), at.f0, dzb)
    return add(add(turn(dc, dphi, at.za), turn(c, phi, dza)), dmunk)


def paper_jacobian(inertia: Inertia, at: PaperEquation) -> Matrix3:
    """Return the 3x3 Jacobian of the residual (P5) at `at`."""
    return matrix_from_columns(
        paper_derivative(inertia, at, (1.0, 0.0, 0.0)),
        paper_derivative(inertia, at, (0.0, 1.0, 0.0)),
        paper_derivative(inertia, at, (0.0, 0.0, 1.0)),
    )


def paper_guess(angle: Vector3) -> Vector3:
    """Return Phi for a small half step angle (h/2) omega: the same."""
    return angle


def paper_increment(at: PaperEquation) -> DualQuaternion:
    """Return the unit dual quaternion f = (c, Phi) + eps (f0, Psi)."""
    phi, psi = at.phi, at.psi
    return DualQuaternion((at.c, phi[0], phi[1], phi[2]), (at.f0, psi[0], psi[1], psi[2]))


PAPER = DriftScheme(paper_equation, paper_jacobian, paper_guess, paper_increment)
paper_drift = make_drift(PAPER)
paper_fallback = make_split_drift(paper_drift)
