"""Fossen's equations of motion together with those of the actuators, written separately from the product.

One system of ordinary differential equations for SciPy: pose, velocity, and the channels x with dx/dt =
clip((c - x)/T, -R, R). Still water; damping linear, quadratic and by couplings.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from support.fossen import coriolis, skew


def actuator_wrench(vehicle, values, nu):
    """What a vehicle's actuators do at given channel values, in Fossen's order."""
    total, it = np.zeros(6), iter(values)
    for thruster in vehicle.thrusters:
        n = next(it)
        r = np.array(thruster.position)
        d = np.array(thruster.direction) / np.linalg.norm(thruster.direction)
        advance = d @ (nu[:3] + skew(nu[3:]) @ r)
        thrust = thruster.gains[0 if n > 0 else 1] * n * abs(n) - thruster.inflow * abs(n) * advance
        total += thrust * np.concatenate([d, skew(r) @ d + thruster.torque_over_thrust * d])
    for azimuth in vehicle.azimuths:
        n, angle = next(it), next(it)
        force = (
            azimuth.gains[0 if n > 0 else 1] * n * abs(n) * np.array([math.cos(angle), math.sin(angle), 0.0])
        )
        total += np.concatenate([force, skew(azimuth.position) @ force])
    for fin in vehicle.fins:
        total += nu[0] * abs(nu[0]) * next(it) * np.array(fin.coefficients)
    return total


def channel_lags(vehicle):
    """Time constants of all channels (inf: at once is not possible here) and largest rates, each in channel order."""
    lags, rates = [], []

    def add(lag, rate):
        lags.append(lag)
        rates.append(math.inf if rate is None else rate)

    for thruster in vehicle.thrusters:
        add(thruster.time_constant, thruster.rate_limit)
    for azimuth in vehicle.azimuths:
        add(azimuth.time_constant, azimuth.rate_limit)
        rate = azimuth.angle_rate_limit_deg_s
        add(azimuth.angle_time_constant, None if rate is None else math.radians(rate))
    for fin in vehicle.fins:
        rate = fin.rate_limit_deg_s
        add(fin.time_constant, None if rate is None else math.radians(rate))
    return np.array(lags), np.array(rates)


def solve(vehicle, position, quaternion, velocity, values, command, duration):
    """Position, rotation matrix, velocity and channel values at `duration`; every channel has a lag."""
    m = vehicle.mass_matrix
    inverse = np.linalg.inv(m)
    lags, rates = channel_lags(vehicle)
    excess = vehicle.weight - vehicle.buoyant_force
    start = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()

    def derivative(_, y):
        r, nu, x = y[3:12].reshape(3, 3), y[12:18], y[18:]
        down = r.T @ np.array([0.0, 0.0, 1.0])
        force = np.concatenate([excess * down, skew(vehicle.restoring_arm) @ down])
        force = force + actuator_wrench(vehicle, x, nu) - coriolis(m, nu) @ nu
        force = force - vehicle.linear_damping @ nu - vehicle.quadratic_damping * np.abs(nu) * nu
        force = force - np.einsum("ijk,j,k->i", vehicle.damping_couplings, nu, np.abs(nu))
        force = force - np.einsum("ijk,j,k->i", vehicle.signed_damping_couplings, nu, nu)
        dx = np.clip((np.asarray(command) - x) / lags, -rates, rates)
        return np.concatenate([r @ nu[:3], (r @ skew(nu[3:])).ravel(), inverse @ force, dx])

    y0 = np.concatenate([position, start.ravel(), velocity, values])
    solution = solve_ivp(derivative, (0.0, duration), y0, method="DOP853", rtol=1e-12, atol=1e-13)
    assert solution.success, solution.message
    y = solution.y[:, -1]
    return y[:3], y[3:12].reshape(3, 3), y[12:18], y[18:]
