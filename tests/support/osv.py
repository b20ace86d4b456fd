"""The offshore supply vessel of MSS as published, written apart from the package: Euler angles and Fossen's matrices.

After T. I. Fossen, Marine Systems Simulator (MIT licence), osv.m, forceSurgeDamping.m and crossFlowDrag.m as of July
2026, and Fossen (2021), Handbook of Marine Craft Hydrodynamics and Motion Control, eqs. 6.111-6.116.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from support.fossen import coriolis, skew

LENGTH, BEAM, DRAFT, DENSITY, GRAVITY = 83.0, 18.0, 5.0, 1025.0, 9.81
VOLUME = 0.65 * LENGTH * BEAM * DRAFT
MASS = DENSITY * VOLUME
CENTER = np.array([-4.5, 0.0, -1.2])
MOST_THRUST = np.array([300e3, 300e3, 420e3, 655e3])
THRUSTER_X, THRUSTER_Y = np.array([37.0, 35.0, -41.5, -41.5]), np.array([0.0, 0.0, 7.0, -7.0])
CRUISE_SPEED, CROSSOVER = 7.7, 2.0
HOERNER = float(np.interp(BEAM / (2.0 * DRAFT), (1.6392, 1.8600), (0.6914, 0.6571)))
"""C_D by Hoerner's curve at B/(2T) = 1.8."""

ADDED = np.zeros((6, 6))
ADDED[np.diag_indices(6)] = (0.6e6, 2.0e6, 8.3e6, 74.8e6, 3987.5e6, 1241.6e6)
for _i, _j, _value in ((1, 3, 3.1e6), (1, 5, -9.1e6), (2, 4, 90.7e6), (3, 5, -112.7e6)):
    ADDED[_i, _j] = ADDED[_j, _i] = _value


def moved(matrix, r):
    """A matrix about a point, about one from which that point is at r."""
    h = np.eye(6)
    h[:3, 3:] = -skew(r)
    return h.T @ matrix @ h


def matrices():
    """M_RB, D without surge, and G, about the body origin."""
    radii = np.array([0.35 * BEAM, 0.25 * LENGTH, 0.25 * LENGTH])
    rigid = moved(MASS * np.diag([1.0, 1.0, 1.0, *radii**2]), CENTER)
    area, cw = 0.8 * LENGTH * BEAM, 0.8
    below = DRAFT - (2.5 * DRAFT - VOLUME / area) / 3.0 - CENTER[2]
    munro_smith = 6.0 * cw**3 / ((1.0 + cw) * (1.0 + 2.0 * cw))
    gm = np.array([munro_smith * BEAM**3 * LENGTH, 0.7 * LENGTH**3 * BEAM]) / 12.0 / VOLUME - below
    at_flotation = DENSITY * GRAVITY * np.diag([0.0, 0.0, area, *(VOLUME * gm), 0.0])
    stiffness = moved(at_flotation, np.array([-0.5, 0.0, 0.0]))
    m = np.diag(rigid + ADDED)
    natural = np.sqrt(np.diag(stiffness)[2:5] / m[2:5])
    damping = np.array([0.0, m[1] / 100.0, *(2.0 * np.array([0.2, 0.15, 0.3]) * natural * m[2:5]), m[5]])
    return rigid, np.diag(damping), stiffness


RIGID, DAMPING, STIFFNESS = matrices()


def resistance(u):
    """Force against motion ahead, forceSurgeDamping.m with the thrust of the cruise speed [N]."""
    linear = (MASS + 2.7 * DENSITY * VOLUME ** (5.0 / 3.0) / LENGTH**2) / 100.0
    quadratic = MOST_THRUST[2:].sum() / CRUISE_SPEED**2
    at_rest = 1.0 - np.tanh(u / CROSSOVER)
    return at_rest * linear * u + (1.0 - at_rest) * quadratic * abs(u) * u


def cross_flow(nu):
    """Drag of 21 stations of a twentieth of the length, in sway and yaw and as published in heave and pitch."""
    x = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, 21)
    across, down = nu[1] + x * nu[5], nu[2] + x * nu[4]
    c = 0.5 * DENSITY * DRAFT * HOERNER * LENGTH / 20.0
    y, z = c * np.abs(across) * across, c * np.abs(down) * down
    return np.array([0.0, y.sum(), z.sum(), 0.0, (x * z).sum(), (x * y).sum()])


def thrust(shares, angles):
    """Wrench of shares of the largest thrusts, shape (4,), with the azimuths at angles, shape (2,)."""
    alpha = np.array([0.5 * np.pi, 0.5 * np.pi, *angles])
    force = MOST_THRUST * np.asarray(shares)
    x, y = force * np.cos(alpha), force * np.sin(alpha)
    return np.array([x.sum(), y.sum(), 0.0, 0.0, 0.0, (THRUSTER_X * y - THRUSTER_Y * x).sum()])


def euler_rotation(phi, theta, psi):
    """Rotation body to NED."""
    (s1, s2, s3), (c1, c2, c3) = np.sin([phi, theta, psi]), np.cos([phi, theta, psi])
    return np.array(
        [
            [c3 * c2, -s3 * c1 + c3 * s2 * s1, s3 * s1 + c3 * c1 * s2],
            [s3 * c2, c3 * c1 + s1 * s2 * s3, -c3 * s1 + s2 * s3 * c1],
            [-s2, c2 * s1, c2 * c1],
        ]
    )


def derivative(state, wrench, current=(0.0, 0.0)):
    """Rates of velocity and of position and Euler angles, shape (12,), in a horizontal current [m/s] in NED."""
    nu, eta = state[:6], state[6:]
    phi, theta, psi = eta[3:]
    c, s = np.cos(psi), np.sin(psi)
    water = np.array([c * current[0] + s * current[1], c * current[1] - s * current[0], 0.0])
    relative = nu - np.array([*water, 0.0, 0.0, 0.0])
    rigid_turning = moved_coriolis(nu[3:])
    force = wrench - (rigid_turning + coriolis(ADDED, nu) + DAMPING) @ relative
    force = force - cross_flow(relative) - STIFFNESS @ eta
    force[0] -= resistance(relative[0])
    acceleration = np.linalg.solve(RIGID + ADDED, force)
    acceleration[:3] -= np.cross(nu[3:], water)
    rates = np.array(
        [
            [1.0, np.sin(phi) * np.tan(theta), np.cos(phi) * np.tan(theta)],
            [0.0, np.cos(phi), -np.sin(phi)],
            [0.0, np.sin(phi) / np.cos(theta), np.cos(phi) / np.cos(theta)],
        ]
    )
    return np.concatenate([acceleration, euler_rotation(phi, theta, psi) @ nu[:3], rates @ nu[3:]])


def moved_coriolis(omega):
    """C_RB of rbody.m, which does not ask for the linear velocity."""
    inertia = RIGID[3:, 3:] + MASS * skew(CENTER) @ skew(CENTER)
    at_center = np.zeros((6, 6))
    at_center[:3, :3], at_center[3:, 3:] = MASS * skew(omega), -skew(inertia @ omega)
    return moved(at_center, CENTER)


def osv_run(wrench, times, current=(0.0, 0.0), start=None):
    """Velocities and positions with Euler angles, a row for each time, under a steady wrench from rest."""
    first = np.zeros(12) if start is None else np.asarray(start, dtype=float)
    solution = solve_ivp(
        lambda _, y: derivative(y, np.asarray(wrench, dtype=float), current),
        (0.0, float(times[-1])), first, t_eval=times, method="LSODA", rtol=1e-8, atol=1e-8,
    )  # fmt: skip
    assert solution.success, solution.message
    return solution.y.T
