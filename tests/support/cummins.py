"""Cummins' equation of small motions, written separately: retardation by quadrature, the convolution by sums."""

from __future__ import annotations

import numpy as np


def retardation(damping, times, highest, points=8001):
    """K(t) = (2/pi) int_0^highest B(w) cos(w t) dw by Simpson's rule in the root of w, shape (times, m, m).

    Args:
        damping: (frequencies, shape (n,)) -> B, shape (n, m, m).
        times: shape (k,) [s].
        highest: where B has fallen to nothing that matters [rad/s].
        points: of the rule, an odd number.
    """
    root = np.linspace(0.0, 1.0, points)
    rule = np.where(np.arange(points) % 2 == 1, 4.0, 2.0)
    rule[[0, -1]] = 1.0
    weights = rule / (3.0 * (points - 1)) * 2.0 * root * highest
    grid = highest * root[1:] ** 2
    b = damping(grid)
    kernel = np.cos(np.outer(times, grid)) @ (weights[1:, None] * b.reshape(grid.size, -1))
    return 2.0 / np.pi * kernel.reshape(len(times), *b.shape[1:])


def free_motion(mass, damping, stiffness, kernel, dt, velocity):
    """Positions and velocities of  M v' + int_0^t K(t - s) v(s) ds + D v + C x = 0, x' = v, from x = 0.

    The trapezoidal rule for the motion, and for the convolution, whose newest term is implicit; second order.

    Args:
        mass: M with the added mass at infinite frequency, shape (m, m).
        damping: D, shape (m, m).
        stiffness: C, shape (m, m).
        kernel: K at 0, dt, 2 dt, ..., shape (steps + 1, m, m).
        dt: [s].
        velocity: at the start, shape (m,).
    """
    steps, size = kernel.shape[0] - 1, kernel.shape[1]
    x, v = np.zeros((steps + 1, size)), np.zeros((steps + 1, size))
    v[0] = velocity
    remembered = np.zeros(size)
    implicit = mass + 0.5 * dt * (damping + 0.5 * dt * kernel[0] + 0.5 * dt * stiffness)
    for n in range(steps):
        past = 0.5 * kernel[n + 1] @ v[0] + np.einsum("kij,kj->i", kernel[n:0:-1], v[1 : n + 1])
        now = damping @ v[n] + stiffness @ x[n] + remembered
        then = stiffness @ (x[n] + 0.5 * dt * v[n]) + dt * past
        v[n + 1] = np.linalg.solve(implicit, mass @ v[n] - 0.5 * dt * (now + then))
        x[n + 1] = x[n] + 0.5 * dt * (v[n] + v[n + 1])
        remembered = dt * (past + 0.5 * kernel[0] @ v[n + 1])
    return x, v
