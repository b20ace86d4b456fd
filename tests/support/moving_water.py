"""Motion of a small body in water that is sheared and accelerates, written separately and solved by SciPy.

In terms of the velocity over ground nu, with u and the water's acceleration a = Du/Dt where the body is:

    M (nu' - [R^T a - omega x R^T u; 0]) = tau - C(nu_r) nu_r - D(nu_r) nu_r + [e R^T a; s x R^T a]

e = rho V - m, s = rho V r_B - m r_G (G. I. Taylor 1928, "The forces on a body placed in a curved or converging stream
of fluid", for a body of any shape: (M_A + rho V) Du/Dt; Auton, Hunt and Prud'homme 1988 on Du/Dt). For a sphere it is
(m + m_A) v' = (rho V + m_A) a.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from support.fossen import coriolis, skew


def solve_in_moving_water(
    m,
    position,
    quaternion,
    velocity,
    duration,
    water,
    acceleration,
    *,
    excess=0.0,
    moment=(0.0, 0.0, 0.0),
    quadratic=(0.0,) * 6,
    wrench=(0.0,) * 6,
    corners=(),
):
    """Position, rotation matrix and velocity over ground at `duration`.

    `water` and `acceleration` are functions of (time, position); where the body crosses one of the depths `corners`,
    the solver starts anew.
    """
    m = np.asarray(m, dtype=float)
    inverse, moment, quadratic = np.linalg.inv(m), np.asarray(moment), np.asarray(quadratic)

    def derivative(time, y):
        r, nu = y[3:12].reshape(3, 3), y[12:]
        u, a = r.T @ water(time, y[:3]), r.T @ acceleration(time, y[:3])
        relative = nu - np.concatenate([u, np.zeros(3)])
        force = (
            np.asarray(wrench) - coriolis(m, relative) @ relative - quadratic * np.abs(relative) * relative
        )
        force = force + np.concatenate([excess * a, skew(moment) @ a])
        along = np.concatenate([a - skew(nu[3:]) @ u, np.zeros(3)])
        return np.concatenate([r @ nu[:3], (r @ skew(nu[3:])).ravel(), inverse @ force + along])

    def crossing(depth):
        def event(time, y):
            return y[2] - depth

        event.terminal = True
        return event

    start = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
    time, y = 0.0, np.concatenate([position, start.ravel(), velocity])
    while time < duration:
        # No event at the depth where the last one was met.
        events = [crossing(depth) for depth in corners if abs(y[2] - depth) > 1e-9]
        solution = solve_ivp(
            derivative, (time, duration), y, method="DOP853", rtol=1e-12, atol=1e-13, events=events
        )
        assert solution.success, solution.message
        time, y = solution.t[-1], solution.y[:, -1]
    return y[:3], y[3:12].reshape(3, 3), y[12:]
