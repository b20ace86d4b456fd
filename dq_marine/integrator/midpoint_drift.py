"""The force-free step ("drift") of the midpoint-frame dual quaternion variational integrator.

Half turn, translate, half turn: the pose increment of a step is f = r (1 + eps y) r with the half rotation
r = (1, t)/sqrt(1 + t.t), where t = tan(theta/4) n holds the modified Rodrigues parameters of the whole
rotation and y is half the displacement in the midpoint frame. The discrete kinetic energy
T_d = (2/h) [2t; y]^T M [2t; y] is Galilean invariant along the rotation axis, unlike that of Xu & Halse
(arXiv 1611.00616), whose scheme differs only in the variable that stands for the rotation.

With the scaled momenta a = (h/2) mu_angular and b = (h/2) mu_linear, and R the rotation of r, stationarity
of the discrete action reads (docs/theory.md, eqs. D1-D5)

    zb = R^T b                                                                                       (D1)
    y  = M22^-1 (zb - 2 M21 t)                                                                       (D2)
    za = 2 M11 t + M12 y                                                                             (D3)
    w  = y x zb                                                                                      (D4)
    (1 - t.t) za + 2 t (t.za) + 2 t x za + w + t x w - a = 0                                         (D5)

three equations in t: the translation is eliminated exactly. Second order, symmetric, one division a residual.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from dq_marine.algebra.axes import X_AXIS, Y_AXIS, Z_AXIS, Axis
from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.matrix3 import Matrix3, matrix_from_columns, transform
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, cross, dot, scale, subtract
from dq_marine.integrator.drift import DriftScheme, make_drift, make_split_drift
from dq_marine.integrator.drift_report import equation_size_squared
from dq_marine.integrator.inertia import Inertia


class DriftEquation(NamedTuple):
    """The discrete equation at one t: its terms (D1)-(D4) and its residual (D5).

    `relative_residual_squared` is |residual|^2 over the sum of its terms' squares, 0 at rest.
    """

    t: Vector3
    gain: float  # 1/(1 + t.t)
    zb: Vector3
    y: Vector3
    za: Vector3
    w: Vector3
    residual: Vector3
    relative_residual_squared: float


def conjugate_unscaled(t: Vector3, a: Vector3) -> Vector3:
    """Return (1 + t.t) R a = (1 - t.t) a + 2 t (t.a) + 2 t x a, R the rotation of (1, t)/sqrt(1 + t.t)."""
    turned = add_scaled(scale(1.0 - dot(t, t), a), 2.0 * dot(t, a), t)
    return add_scaled(turned, 2.0, cross(t, a))


def turn_half_back(t: Vector3, gain: float, a: Vector3) -> Vector3:
    """Return R^T a: from the frame at the start of the step to the midpoint frame."""
    return scale(gain, conjugate_unscaled((-t[0], -t[1], -t[2]), a))


def drift_equation(inertia: Inertia, t: Vector3, a: Vector3, b: Vector3) -> DriftEquation:
    """Evaluate (D1)-(D5) at t."""
    gain = 1.0 / (1.0 + dot(t, t))
    zb = turn_half_back(t, gain, b)  # (D1)
    y = transform(  # (D2)
        inertia.linear_block_inverse,
        add_scaled(zb, -2.0, transform(inertia.matrix.linear_angular, t)),
    )
    coupled = transform(inertia.matrix.angular_linear, y)
    za = add(scale(2.0, transform(inertia.matrix.angular, t)), coupled)  # (D3)
    w = cross(y, zb)  # (D4)
    residual = subtract(add(add(conjugate_unscaled(t, za), w), cross(t, w)), a)  # (D5)
    relative = dot(residual, residual) / equation_size_squared(a, za, w, y, zb, coupled)
    return DriftEquation(t, gain, zb, y, za, w, residual, relative)


def make_drift_derivative(axis: Axis) -> Callable[[Inertia, DriftEquation], Vector3]:
    """Return (inertia, at) -> the derivative of the residual (D5) at `at` when t grows along an axis."""
    along, column, lengthen, turned, add_cross = axis

    def drift_derivative(inertia: Inertia, at: DriftEquation) -> Vector3:
        t = at.t
        dzb = cross(at.zb, turned(2.0 * at.gain, t))  # by the half rotation's angular increment
        dy = transform(
            inertia.linear_block_inverse,
            add_scaled(dzb, -2.0, column(inertia.matrix.linear_angular)),
        )
        dza = add(
            scale(2.0, column(inertia.matrix.angular)),
            transform(inertia.matrix.angular_linear, dy),
        )
        dw = add(cross(dy, at.zb), cross(at.y, dzb))
        turning = lengthen(scale(-2.0 * along(t), at.za), 2.0 * dot(t, at.za))
        turning = add_scaled(turning, 2.0 * along(at.za), t)
        turning = add_cross(turning, 2.0, at.za)
        turning = add(turning, conjugate_unscaled(t, dza))
        return add(add_cross(turning, 1.0, at.w), add(dw, cross(t, dw)))

    return drift_derivative


derivative_along_x = make_drift_derivative(X_AXIS)
derivative_along_y = make_drift_derivative(Y_AXIS)
derivative_along_z = make_drift_derivative(Z_AXIS)


def drift_jacobian(inertia: Inertia, at: DriftEquation) -> Matrix3:
    """Return the 3x3 Jacobian of the residual (D5) at `at`."""
    return matrix_from_columns(
        derivative_along_x(inertia, at), derivative_along_y(inertia, at), derivative_along_z(inertia, at)
    )


def pose_increment(at: DriftEquation) -> DualQuaternion:
    """Return the unit dual quaternion f = r (1 + eps y) r of the step, for pose' = pose f.

    Multiplied out: r r = (1 - t.t, 2 t)/(1 + t.t) and r y r = (-2 t.y, (1 + t.t) y - 2 (t.y) t)/(1 + t.t).
    """
    t = at.t
    real_vector = scale(2.0 * at.gain, t)
    along = dot(t, at.y)
    dual_vector = add_scaled(at.y, -2.0 * at.gain * along, t)
    return DualQuaternion(
        ((1.0 - dot(t, t)) * at.gain, real_vector[0], real_vector[1], real_vector[2]),
        (-2.0 * at.gain * along, dual_vector[0], dual_vector[1], dual_vector[2]),
    )


def midpoint_guess(angle: Vector3) -> Vector3:
    """Return t for a small half step angle (h/2) omega: half of it."""
    return scale(0.5, angle)


MIDPOINT = DriftScheme(drift_equation, drift_jacobian, midpoint_guess, pose_increment)
midpoint_drift = make_drift(MIDPOINT)
midpoint_fallback = make_split_drift(midpoint_drift)
