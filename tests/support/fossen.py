"""Fossen's equations of motion, written separately from the product and solved by SciPy.

M nu_r' + C(nu_r) nu_r + D(nu_r) nu_r + g = tau with the Earth-fixed kinematics (Fossen 2021, eqs. 6.111-6.116),
C from M by Fossen's parametrisation (Theorem 3.2). Rotation matrices instead of quaternions, so that nothing is
shared with the product but the physics.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation


def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def coriolis(m, nu):
    """C(nu) from M, skew-symmetric."""
    upper = m[:3, :3] @ nu[:3] + m[:3, 3:] @ nu[3:]
    lower = m[3:, :3] @ nu[:3] + m[3:, 3:] @ nu[3:]
    zero = np.zeros((3, 3))
    return np.block([[zero, -skew(upper)], [-skew(upper), -skew(lower)]])


def strip_drag(plane, coefficient, first, spacing, number, nu):
    """Cross-flow drag of strips at x, of their own velocity across the hull: that of the water at r x (x, 0, 0)."""
    drag = np.zeros(6)
    for x in first + spacing * np.arange(number):
        velocity = nu[:3] + skew(nu[3:]) @ (x, 0.0, 0.0)
        axis = 1 if plane == "sway" else 2
        force = np.zeros(3)
        force[axis] = coefficient * abs(velocity[axis]) * velocity[axis]
        drag += np.concatenate([force, skew((x, 0.0, 0.0)) @ force])
    return drag


def blended_drag(axis, linear, quadratic, crossover, nu):
    """Drag in one axis that is linear at rest and quadratic far beyond a surge speed."""
    under_way = np.tanh(abs(nu[0]) / crossover)
    drag = np.zeros(6)
    drag[axis] = ((1.0 - under_way) * linear + under_way * quadratic * abs(nu[axis])) * nu[axis]
    return drag


def solve(
    m,
    position,
    quaternion,
    velocity,
    duration,
    *,
    excess_weight=0.0,
    arm=(0.0, 0.0, 0.0),
    linear=None,
    quadratic=None,
    couplings=None,
    strips=(),
    blends=(),
    signed=None,
    current=(0.0, 0.0, 0.0),
    wrench=(0.0,) * 6,
    rtol=1e-12,
    method="DOP853",
):
    """Position, rotation matrix and velocity over ground at `duration`."""
    m = np.asarray(m, dtype=float)
    inverse = np.linalg.inv(m)
    linear = np.zeros((6, 6)) if linear is None else np.asarray(linear, dtype=float)
    quadratic = np.zeros(6) if quadratic is None else np.asarray(quadratic, dtype=float)
    couplings, signed = (
        np.zeros((6, 6, 6)) if c is None else np.asarray(c, dtype=float) for c in (couplings, signed)
    )
    arm, current, wrench = (np.asarray(a, dtype=float) for a in (arm, current, wrench))
    start = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()

    def derivative(_, y):
        r = y[3:12].reshape(3, 3)
        nu = y[12:]
        water = np.concatenate([r.T @ current, np.zeros(3)])
        relative = nu - water
        down = r.T @ np.array([0.0, 0.0, 1.0])
        restoring = np.concatenate([excess_weight * down, skew(arm) @ down])
        force = wrench + restoring - coriolis(m, relative) @ relative
        force = force - linear @ relative - quadratic * np.abs(relative) * relative
        force = force - np.einsum("ijk,j,k->i", couplings, relative, np.abs(relative))
        force = force - np.einsum("ijk,j,k->i", signed, relative, relative)
        for plane, row in strips:
            force = force - strip_drag(plane, *row, relative)
        for axis, numbers in blends:
            force = force - blended_drag(axis, *numbers, relative)
        # The water's velocity is constant in NED, hence turns in the body frame.
        turning = np.concatenate([-skew(nu[3:]) @ water[:3], np.zeros(3)])
        return np.concatenate([r @ nu[:3], (r @ skew(nu[3:])).ravel(), inverse @ force + turning])

    y0 = np.concatenate([position, start.ravel(), velocity])
    solution = solve_ivp(
        derivative, (0.0, duration), y0, method=method, rtol=rtol, atol=1e-13, dense_output=False
    )
    assert solution.success, solution.message
    y = solution.y[:, -1]
    return y[:3], y[3:12].reshape(3, 3), y[12:]


def errors(body, reference):
    """Position error [m], attitude error [rad] and velocity error of a body against `solve`'s result."""
    position, rotation, velocity = reference
    own = Rotation.from_quat(np.roll(body.quaternion_body_to_ned, -1)).as_matrix()
    angle = Rotation.from_matrix(rotation.T @ own).magnitude()
    return (
        float(np.linalg.norm(body.position_ned - position)),
        float(angle),
        float(np.linalg.norm(body.velocity_body - velocity)),
    )
