"""The Mariner class ship in three degrees of freedom, written separately from the product and solved by SciPy.

Chislett and Stroem-Tejsen's coefficients (1965) in the equations of motion of mariner.m (Fossen and Perez,
Marine Systems Simulator), about 15 knots: all that is not an acceleration is in the polynomials. Rudder angles here are
the published ones, which turn the ship to port where they are positive.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

LENGTH, SERVICE_SPEED, DENSITY = 160.93, 7.7175, 1025.0
LAG, RATE, LARGEST = 1.0, math.radians(5.0), math.radians(40.0)
"""Of the rudder: time constant [s], rate [rad/s], angle [rad]."""

MASS, INERTIA, CENTER = 798e-5, 39.2e-5, -0.023
"""m' and I'_z over rho/2 L^3 and rho/2 L^5, x'_G over L."""

TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}


def polynomials(u, v, r, d):
    """X', Y', N' of dimensionless motions and the published rudder angle."""
    x = -184e-5 * u - 110e-5 * u**2 - 215e-5 * u**3 - 899e-5 * v**2 + 18e-5 * r**2 + 798e-5 * r * v
    x += -95e-5 * d**2 - 190e-5 * u * d**2 + 93e-5 * v * d + 93e-5 * u * v * d
    y = -1160e-5 * v - 499e-5 * r - 8078e-5 * v**3 + 15356e-5 * v**2 * r - 1160e-5 * v * u - 499e-5 * r * u
    y += 278e-5 * d - 90e-5 * d**3 + 556e-5 * u * d + 278e-5 * u**2 * d - 4e-5 * v * d**2 + 1190e-5 * v**2 * d
    y += -4e-5 - 8e-5 * u - 4e-5 * u**2
    n = -264e-5 * v - 166e-5 * r + 1636e-5 * v**3 - 5483e-5 * v**2 * r - 264e-5 * v * u - 166e-5 * r * u
    n += (
        -139e-5 * d + 45e-5 * d**3 - 278e-5 * u * d - 139e-5 * u**2 * d + 13e-5 * v * d**2 - 489e-5 * v**2 * d
    )
    n += 3e-5 + 6e-5 * u + 3e-5 * u**2
    return x, y, n


class Mariner:
    """The ship: `Y'_rdot` and `N'_vdot` as they were measured, or with the mean of both in the place of each."""

    def __init__(self, *, symmetric=False):
        y_rdot, n_vdot = -9.354e-5, 4.646e-5
        if symmetric:
            y_rdot = n_vdot = 0.5 * (y_rdot + n_vdot)
        self.surge_mass = MASS + 42e-5
        self.lateral_mass = np.array(
            [[MASS + 748e-5, MASS * CENTER - y_rdot], [MASS * CENTER - n_vdot, INERTIA + 43.8e-5]]
        )

    def rates(self, u, v, r, d):
        """Rates of u, v [m/s^2] and r [rad/s^2]; u is the whole speed ahead, d the published rudder angle."""
        speed = math.hypot(u, v)
        x, y, n = polynomials((u - SERVICE_SPEED) / speed, v / speed, r * LENGTH / speed, d)
        sway, yaw = np.linalg.solve(self.lateral_mass, [y, n])
        per_length = speed**2 / LENGTH
        return per_length * x / self.surge_mass, per_length * sway, per_length / LENGTH * yaw

    def derivative(self, state, ordered):
        """Rates of x, y, psi, u, v, r, delta when an angle is ordered, both as published."""
        _, _, psi, u, v, r, d = state
        gap = max(-LARGEST, min(LARGEST, ordered)) - d
        return (
            u * math.cos(psi) - v * math.sin(psi),
            u * math.sin(psi) + v * math.cos(psi),
            r,
            *self.rates(u, v, r, d),
            max(-RATE, min(RATE, gap / LAG)),
        )

    def start(self):
        """The straight course at the service speed, rudder amidships."""
        return np.array([0.0, 0.0, 0.0, SERVICE_SPEED, 0.0, 0.0, 0.0])

    def held(self, state, ordered, duration, until=None):
        """The solution under an order that stands, up to a duration or to where `until` changes its sign."""

        def event(t, state):
            return until(state)

        event.terminal = True
        return solve_ivp(
            lambda t, state: self.derivative(state, ordered),
            (0.0, duration),
            state,
            events=None if until is None else event,
            **TIGHT,
        )

    def turn(self, degrees, side):
        """Advance, transfer, tactical diameter [m], steady speed [m/s] of a turn to starboard (1) or port (-1)."""
        angle = -side * math.radians(degrees)

        def at(heading):
            return self.held(self.start(), angle, 1500.0, lambda state: side * state[2] - heading).y[:2, -1]

        (advance, transfer), (_, diameter) = at(0.5 * math.pi), at(math.pi)
        u, v = self.held(self.start(), angle, 1500.0).y[3:5, -1]
        return advance, side * transfer, side * diameter, math.hypot(u, v)

    def overshoots(self, degrees, side, count=2):
        """Overshoots [degrees] of a zig-zag whose helm is put first to starboard (1) or port (-1)."""
        angle, state, found = math.radians(degrees), self.start(), []
        while len(found) < count:
            state = self.held(state, -side * angle, 600.0, lambda s, a=side: a * s[2] - angle).y[:, -1]
            peak = self.held(state, side * angle, 600.0, lambda s: s[5]).y[:, -1]
            found.append(math.degrees(side * peak[2]) - degrees)
            side = -side  # on from the reversal: from the peak the same order would stand
        return found
