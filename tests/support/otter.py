"""The Maritime Robotics Otter as published, written apart from the package: Euler angles and Fossen's matrices.

After T. I. Fossen, Python Vehicle Simulator, otter.py (MIT licence), and Fossen (2021), Handbook of Marine Craft
Hydrodynamics and Motion Control. Cross-flow drag by strips at 21 stations, Hoerner's curve.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81
WATER_DENSITY = 1025.0
CROSS_FLOW_DENSITY = 1026.0
HULL_MASS, PAYLOAD_MASS = 55.0, 25.0
MASS = HULL_MASS + PAYLOAD_MASS
HULL_CENTER, PAYLOAD = np.array([0.2, 0.0, -0.2]), np.array([0.05, 0.0, -0.35])
CENTER = (HULL_MASS * HULL_CENTER + PAYLOAD_MASS * PAYLOAD) / MASS
LENGTH, BEAM = 2.0, 1.08
PONTOON_BEAM, PONTOON_ARM = 0.25, 0.395
WATERPLANE_COEFFICIENT, BLOCK_COEFFICIENT = 0.75, 0.4
FLOTATION = np.array([-0.2, 0.0, 0.0])
TOP_SPEED, TOP_THRUST = 6.0 * 0.5144, 24.4 * GRAVITY
PROPELLER_FORWARD, PROPELLER_REVERSE, PROPELLER_TIME = 0.01108, 0.006445, 0.1


def cross(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def moved(r):
    """H(r): velocity of a point r from that of the origin."""
    h = np.eye(6)
    h[:3, 3:] = cross(r).T
    return h


VOLUME = MASS / WATER_DENSITY
DRAFT = VOLUME / (2.0 * BLOCK_COEFFICIENT * PONTOON_BEAM * LENGTH)


def cross_flow_coefficient():
    """Hoerner's curve at beam/(2 draft), between the two points around it."""
    ratio = PONTOON_BEAM / (2.0 * DRAFT)
    return float(np.interp(ratio, [0.5585, 0.6464], [1.0836, 0.9986]))


def inertia_matrices():
    """M_RB and M_A, shape (6, 6)."""
    radii = np.array([0.4 * BEAM, 0.25 * LENGTH, 0.25 * LENGTH])
    inertia = (
        HULL_MASS * np.diag(radii**2)
        - HULL_MASS * cross(CENTER) @ cross(CENTER)
        - PAYLOAD_MASS * cross(PAYLOAD) @ cross(PAYLOAD)
    )
    at_center = np.zeros((6, 6))
    at_center[:3, :3], at_center[3:, 3:] = MASS * np.eye(3), inertia
    h = moved(CENTER)
    fractions = np.array([0.1, 1.5, 1.0, 0.2, 0.8, 1.7])
    added = np.diag(fractions * np.array([HULL_MASS] * 3 + list(np.diag(inertia))))
    return h.T @ at_center @ h, added


def restoring_at_flotation():
    """Diagonal of G about the centre of flotation, shape (6,)."""
    area = WATERPLANE_COEFFICIENT * LENGTH * PONTOON_BEAM
    c = WATERPLANE_COEFFICIENT
    transverse = (
        2.0 / 12.0 * LENGTH * PONTOON_BEAM**3 * (6.0 * c**3 / ((1.0 + c) * (1.0 + 2.0 * c)))
        + 2.0 * area * PONTOON_ARM**2
    )
    longitudinal = 0.8 * 2.0 / 12.0 * PONTOON_BEAM * LENGTH**3
    buoyancy_height = (2.5 * DRAFT - 0.5 * VOLUME / (LENGTH * PONTOON_BEAM)) / 3.0
    gravity_height = DRAFT - CENTER[2]
    heights = [buoyancy_height + i / VOLUME - gravity_height for i in (transverse, longitudinal)]
    weight = WATER_DENSITY * GRAVITY * VOLUME
    return np.array(
        [0.0, 0.0, WATER_DENSITY * GRAVITY * 2.0 * area, weight * heights[0], weight * heights[1], 0.0]
    )


def restoring_matrix():
    """G about the body origin, shape (6, 6)."""
    h = moved(FLOTATION)
    return h.T @ np.diag(restoring_at_flotation()) @ h


def damping_diagonal():
    """Linear damping, shape (6,): from top speed and thrust, time constants, and relative damping."""
    rigid, added = inertia_matrices()
    m, g = np.diag(rigid + added), restoring_at_flotation()
    relative = [2.0 * zeta * np.sqrt(g[i] / m[i]) * m[i] for i, zeta in ((2, 0.3), (3, 0.2), (4, 0.4))]
    return np.array([TOP_THRUST / TOP_SPEED, m[1] / 1.0, *relative, m[5] / 1.0])


def thrust(speeds):
    return np.where(speeds > 0.0, PROPELLER_FORWARD, PROPELLER_REVERSE) * speeds * np.abs(speeds)


def cross_flow(velocity):
    station, width = np.linspace(-LENGTH / 2.0, LENGTH / 2.0, 21), LENGTH / 20.0
    across = velocity[1] + station * velocity[5]
    force = -0.5 * CROSS_FLOW_DENSITY * DRAFT * cross_flow_coefficient() * np.abs(across) * across * width
    return np.array([0.0, force.sum(), 0.0, 0.0, 0.0, (station * force).sum()])


def coriolis(m, velocity):
    momentum = m @ velocity
    return np.concatenate(
        [
            cross(velocity[3:]) @ momentum[:3],
            cross(velocity[:3]) @ momentum[:3] + cross(velocity[3:]) @ momentum[3:],
        ]
    )


def rotation(phi, theta, psi):
    c, s = np.cos, np.sin
    about_z = np.array([[c(psi), -s(psi), 0.0], [s(psi), c(psi), 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[c(theta), 0.0, s(theta)], [0.0, 1.0, 0.0], [-s(theta), 0.0, c(theta)]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, c(phi), -s(phi)], [0.0, s(phi), c(phi)]])
    return about_z @ about_y @ about_x


def euler_rates(phi, theta, rates):
    p, q, r = rates
    turning = q * np.sin(phi) + r * np.cos(phi)
    return np.array([p + turning * np.tan(theta), q * np.cos(phi) - r * np.sin(phi), turning / np.cos(theta)])


def otter_run(commands, times, current_ned=(0.0, 0.0, 0.0)):
    """Positions, Euler angles, velocities over ground and propeller speeds, shape (len(times), 14).

    Args:
        commands: (t) -> speeds of the left and the right propeller [rad/s].
        times: of the output [s], from rest at the origin at 0.
        current_ned: of the water [m/s].
    """
    rigid, added = inertia_matrices()
    mass_matrix, g = rigid + added, restoring_matrix()
    inverse, damping, flow = np.linalg.inv(mass_matrix), damping_diagonal(), np.array(current_ned)

    def slope(t, y):
        position, angles, velocity, speeds = y[:3], y[3:6], y[6:12], y[12:]
        r = rotation(*angles)
        relative = velocity - np.concatenate([r.T @ flow, np.zeros(3)])
        left, right = thrust(speeds)
        weight = r.T @ np.array([0.0, 0.0, PAYLOAD_MASS * GRAVITY])
        force = np.array([left + right, 0.0, 0.0, 0.0, 0.0, PONTOON_ARM * (left - right)])
        force += np.concatenate([weight, cross(PAYLOAD) @ weight]) + cross_flow(relative)
        force -= damping * relative + g @ np.concatenate([position, angles])
        force[5] -= 10.0 * damping[5] * np.abs(relative[5]) * relative[5]
        acceleration = inverse @ (force - coriolis(mass_matrix, relative))
        acceleration[:3] -= cross(velocity[3:]) @ (r.T @ flow)
        lag = (np.asarray(commands(t)) - speeds) / PROPELLER_TIME
        return np.concatenate([r @ velocity[:3], euler_rates(*angles[:2], velocity[3:]), acceleration, lag])

    start = np.zeros(14)
    solution = solve_ivp(
        slope, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-6, atol=1e-8, max_step=0.1
    )
    return solution.y.T
