"""The MMG equations in three degrees of freedom, written separately from the product and solved by SciPy.

Yasukawa and Yoshimura (2015), eqs. 4 to 24, with v at midship: their own form of the equations, in which the hull's
polynomials hold all that is not on the left side. Angles and divisions as they are printed, so that nothing is shared
with the product but the numbers of the ship.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

HULL = {"R0": 0.022, "Xvv": -0.040, "Xvr": 0.002, "Xrr": 0.011, "Xvvvv": 0.771}
HULL |= {"Yv": -0.315, "Yr": 0.083, "Yvvv": -1.607, "Yvvr": 0.379, "Yvrr": -0.391, "Yrrr": 0.008}
HULL |= {"Nv": -0.137, "Nr": -0.049, "Nvvv": -0.030, "Nvvr": -0.294, "Nvrr": 0.055, "Nrrr": -0.013}


def gaussian_wake(beta_p):
    """1 - w_P of shipmmg, with its own lever."""
    return 1.0 - 0.40 * math.exp(-4.0 * beta_p**2)


def two_constants_wake(beta_p):
    """1 - w_P by Yasukawa and Yoshimura's eq. 16."""
    c2 = 1.6 if beta_p > 0.0 else 1.1
    return 0.6 * (1.0 + (1.0 - math.exp(-2.0 * abs(beta_p))) * (c2 - 1.0))


class KvlccModel:
    """KVLCC2 of 7 m: what `forces` and `rates` need."""

    def __init__(self, wake=two_constants_wake, x_p=-0.48, *, rho=1025.0, scale=1.0, drift_at=0.0):
        """`drift_at` is the station, in m, whose speed and drift angle the forces follow; 0 is midship."""
        self.wake, self.x_p, self.rho, self.drift_at = wake, x_p, rho, drift_at * scale
        self.L, self.d, self.D, self.HR, self.AR = (
            7.0 * scale,
            0.46 * scale,
            0.216 * scale,
            0.345 * scale,
            0.0539 * scale**2,
        )
        self.m, self.xg = 3.27 * scale**3 * rho, 0.25 * scale
        self.mx, self.my = (k * 0.5 * rho * self.L**2 * self.d for k in (0.022, 0.223))
        self.iz, self.jz = self.m * (0.25 * self.L) ** 2, 0.011 * 0.5 * rho * self.L**4 * self.d

    def forces(self, u, v, r, delta, n):
        """X, Y, N of hull, propeller and rudder."""
        h, rho, length, d = HULL, self.rho, self.L, self.d
        across = v + self.drift_at * r
        speed, beta = math.hypot(u, across), math.atan2(-across, u)
        a, b = v / speed, r * length / speed
        x = -h["R0"] + h["Xvv"] * a * a + h["Xvr"] * a * b + h["Xrr"] * b * b + h["Xvvvv"] * a**4
        y = h["Yv"] * a + h["Yr"] * b + h["Yvvv"] * a**3 + h["Yvvr"] * a * a * b + h["Yvrr"] * a * b * b
        y += h["Yrrr"] * b**3
        z = h["Nv"] * a + h["Nr"] * b + h["Nvvv"] * a**3 + h["Nvvr"] * a * a * b + h["Nvrr"] * a * b * b
        z += h["Nrrr"] * b**3
        pressure = 0.5 * rho * length * d * speed**2
        flow = self.wake(beta - self.x_p * b)
        advance = u * flow / (n * self.D)
        kt = 0.2931 - 0.2753 * advance - 0.1385 * advance**2
        eta, kappa, epsilon = self.D / self.HR, 0.50, 1.09
        race = 1.0 + kappa * (math.sqrt(1.0 + 8.0 * kt / (math.pi * advance**2)) - 1.0)
        u_r = epsilon * u * flow * math.sqrt(eta * race**2 + 1.0 - eta)
        beta_r = beta + 0.710 * b
        v_r = speed * (0.395 if beta_r < 0.0 else 0.640) * beta_r
        normal = 0.5 * rho * self.AR * 2.747 * (u_r**2 + v_r**2) * math.sin(delta - math.atan2(v_r, u_r))
        return (
            pressure * x
            + (1.0 - 0.220) * rho * n**2 * self.D**4 * kt
            - (1.0 - 0.387) * normal * math.sin(delta),
            pressure * y - (1.0 + 0.312) * normal * math.cos(delta),
            pressure * length * z + (0.500 + 0.312 * 0.464) * length * normal * math.cos(delta),
        )

    def rates(self, u, v, r, delta, n):
        """du/dt, dv/dt, dr/dt of the MMG equations of motion (eq. 4)."""
        x, y, z = self.forces(u, v, r, delta, n)
        m, xg, mx, my = self.m, self.xg, self.mx, self.my
        inertia = self.iz + xg**2 * m + self.jz
        matrix = [[m + my, xg * m], [xg * m, inertia]]
        dv, dr = np.linalg.solve(matrix, [y - (m + mx) * u * r, z - xg * m * u * r])
        return (x + (m + my) * v * r + xg * m * r * r) / (m + mx), dv, dr

    def turn(self, rudder_deg, *, u0=1.179, n=11.8516, rate_deg=15.8, duration=200.0):
        """Times, and x, y, psi, u, v, r at each, of a turn from a straight course."""
        full, rate = math.radians(rudder_deg), math.radians(rate_deg)

        def derivative(t, state):
            _, _, psi, u, v, r = state
            delta = math.copysign(min(rate * t, abs(full)), full)
            return (
                u * math.cos(psi) - v * math.sin(psi),
                u * math.sin(psi) + v * math.cos(psi),
                r,
                *self.rates(u, v, r, delta, n),
            )

        times = np.linspace(0.0, duration, round(duration / 0.05) + 1)
        start = (0.0, 0.0, 0.0, u0, 0.0, 0.0)
        corner = abs(full) / rate  # the rudder stops: a kink, which the solver is not led across
        first = solve_ivp(derivative, (0.0, corner), start, method="DOP853", rtol=1e-11, atol=1e-12)
        later = solve_ivp(
            derivative,
            (corner, duration),
            first.y[:, -1],
            method="DOP853",
            rtol=1e-11,
            atol=1e-12,
            dense_output=True,
        )
        return times[times >= corner], later.sol(times[times >= corner])


def turning_figures(states, length):
    """Advance, transfer and tactical diameter in lengths."""
    x, y, psi = states[:3]
    heading = np.abs(psi)

    def at(angle, what):
        index = int(np.argmax(heading >= math.radians(angle)))
        before, after = heading[index - 1], heading[index]
        share = (math.radians(angle) - before) / (after - before)
        return abs(what[index - 1] + share * (what[index] - what[index - 1])) / length

    return at(90.0, x), at(90.0, y), at(180.0, y)
