"""Variations of a matrix that keep it symmetric, positive (semi)definite or dissipative in every draw.

A congruence A' = T A T^T with an invertible T has as many positive, zero and negative eigenvalues as a symmetric A
(Sylvester's law of inertia), and as v . A' v = (T^T v) . A (T^T v), it takes energy wherever A does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def scaled_and_coupled(matrix: Array, factors: Array, coupling: Array, scale: Array) -> Array:
    """Return T A T^T with T = diag(sqrt(factors)) diag(scale) (1 + coupling) diag(1/scale).

    Without coupling, entry ij grows by sqrt(f_i f_j): the diagonal by its factors.

    Args:
        matrix: A, shape (n, n).
        factors: above 0, shape (n,).
        coupling: K, zero on the diagonal, row sums of magnitudes below 1, so that 1 + K is invertible, shape (n, n).
        scale: a unit for each axis, that makes entries of different units comparable; an axis of scale 0 is not
            coupled, shape (n,).
    """
    ratios = np.divide(np.outer(scale, scale > 0.0), scale, out=np.zeros_like(coupling), where=scale > 0.0)
    shear = np.eye(len(factors)) + coupling * ratios
    transformation = np.sqrt(factors)[:, None] * shear
    return np.asarray(transformation @ matrix @ transformation.T)


def drawn_coupling(largest: float, size: int, rng: np.random.Generator) -> Array:
    """Return a matrix of uniform draws between -largest and largest, zero on the diagonal, shape (size, size)."""
    if largest == 0.0:
        return np.zeros((size, size))
    draws = rng.uniform(-largest, largest, (size, size))
    np.fill_diagonal(draws, 0.0)
    return draws


def second_moments(inertia: Array) -> Array:
    """Return the second moments of mass, the integral of r r^T dm, of moments of inertia, both of shape (3, 3).

    I = tr(S) 1 - S: the principal moments of I obey the triangle inequalities exactly where S is positive semidefinite;
    what a vehicle file leaves below zero, by round-off or as published, becomes zero.
    """
    moments = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    values, axes = np.linalg.eigh(moments)
    if values[0] >= 0.0:
        return np.asarray(moments)
    return np.asarray(axes @ np.diag(np.maximum(values, 0.0)) @ axes.T)


def moments_of_inertia(moments: Array) -> Array:
    """Return I = tr(S) 1 - S, the inverse of `second_moments`, shape (3, 3)."""
    return np.asarray(np.trace(moments) * np.eye(3) - moments)
