"""Xu & Halse's step as they print it: six unknowns (Phi, Psi), NumPy, with and without its errata corrected.

Kept apart from the product, which solves three unknowns: the reference that the reduced form must match.
"""

from __future__ import annotations

import numpy as np


def skew(a):
    zero = 0.0 * a[0]
    return np.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]])


def residual(m, x, a, b):
    """[A - a; B - b] of the discrete equation at x = (Phi, Psi); m angular first."""
    phi, psi = x[:3], x[3:]
    c = np.sqrt(1.0 - phi @ phi)
    za, zb = m[:3] @ x, m[3:] @ x
    turn = c * np.eye(3) + skew(phi)
    upper = turn @ za - (psi @ phi) / c * zb + np.cross(psi, zb)
    return np.concatenate([upper - a, turn @ zb - b])


def f0_gradient_corrected(phi, psi):
    """d(-Psi.Phi/c)/dPhi = (-Phi x (Phi x Psi) - Psi)^T / c^3."""
    c = np.sqrt(1.0 - phi @ phi)
    return (-np.cross(phi, np.cross(phi, psi)) - psi) / c**3


def f0_gradient_printed(phi, psi):
    """The paper prints (Phi x (Phi x Psi) - Psi)^T / c^3."""
    c = np.sqrt(1.0 - phi @ phi)
    return (np.cross(phi, np.cross(phi, psi)) - psi) / c**3


def lost_terms(m, x):
    """The part of dA/dPsi that the paper leaves out: S(Psi) M22 - S(M22 Psi)."""
    psi = x[3:]
    return skew(psi) @ m[3:, 3:] - skew(m[3:, 3:] @ psi)


def jacobian(m, x, *, f0_gradient=f0_gradient_corrected, lost=lost_terms):
    """The general 6x6 Jacobian; the printed one with `f0_gradient_printed` and `lost` returning zeros."""
    phi, psi = x[:3], x[3:]
    c = np.sqrt(1.0 - phi @ phi)
    m11, m12, m21, m22 = m[:3, :3], m[:3, 3:], m[3:, :3], m[3:, 3:]
    za, zb = m[:3] @ x, m[3:] @ x
    f0 = -(psi @ phi) / c
    turn = c * np.eye(3) + skew(phi)
    turn_za = turn @ m11 - np.outer(za, phi) / c - skew(za)
    a_phi = turn_za + np.outer(zb, f0_gradient(phi, psi)) + f0 * m21 + skew(psi) @ m21
    a_psi = turn @ m12 - np.outer(zb, phi) / c + f0 * m22 - skew(m21 @ phi) + lost(m, x)
    b_phi = turn @ m21 - np.outer(zb, phi) / c - skew(zb)
    return np.block([[a_phi, a_psi], [b_phi, turn @ m22]])


def jacobian_about_com(m, x):
    """The Jacobian simplified for M12 = 0 and M22 = m 1, where the lost terms vanish (errata corrected)."""
    phi, psi = x[:3], x[3:]
    mass = m[3, 3]
    c = np.sqrt(1.0 - phi @ phi)
    inertia = m[:3, :3]
    za = inertia @ phi
    turn = c * np.eye(3) + skew(phi)
    a_phi = turn @ inertia - np.outer(za, phi) / c - skew(za)
    a_phi = a_phi + mass * np.outer(psi, f0_gradient_corrected(phi, psi))
    a_psi = -mass * (np.outer(psi, phi) / c + (psi @ phi) / c * np.eye(3))
    b_phi = -mass * (np.outer(psi, phi) / c + skew(psi))
    return np.block([[a_phi, a_psi], [b_phi, mass * turn]])


def solve(m, a, b, h, *, jacobian=jacobian, iterations=50, start=None):
    """Newton's method on six unknowns from x = (h/2) chi; returns x and the residual norms met."""
    target = np.concatenate([a, b])
    x = np.linalg.solve(m, target) if start is None else start
    norms = []
    for _ in range(iterations):
        r = residual(m, x, a, b)
        norms.append(float(np.linalg.norm(r) / np.linalg.norm(target)))
        if norms[-1] < 3e-16:
            break
        x = x - np.linalg.solve(jacobian(m, x), r)
    return x, norms
