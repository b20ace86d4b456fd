"""What a log can tell: standard errors, and the parameters that have to be held because theirs is too large."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HIGH_CORRELATION = 0.95
"""Of two estimates, from which they are named: the log tells their combination better than each."""


LARGEST_SHARE = 0.5
"""Of what a log feels of a parameter: from a larger share of noise on, it is the noise that would be fitted."""


class Held(NamedTuple):
    """A parameter that is held at its nominal value.

    Attributes:
        place: of it, among all.
        standard_error: of theta, about the relative one, which it would have [1]; infinite if the log does not feel it.
    """

    place: int
    standard_error: float


def covariance(jacobian: Array) -> Array:
    """Return the inverse of J^T J, for residuals over their noise; enormous along what the log does not feel."""
    scale = np.linalg.norm(jacobian, axis=0)
    scale = np.where(scale > 0.0, scale, 1e-100)
    _, singular, rotation = np.linalg.svd(jacobian / scale, full_matrices=False)
    half = rotation.T / np.maximum(singular, 1e-13)
    return np.asarray((half @ half.T) / np.outer(scale, scale))


def standard_errors(jacobian: Array) -> Array:
    """Return the standard errors of theta, for residuals over their noise."""
    return np.asarray(np.sqrt(np.diag(covariance(jacobian))))


def told(jacobian: Array, shares: Array, free: list[int], bound: float) -> tuple[list[int], list[Held]]:
    """Return the parameters that can be told, and those that are held, the least certain first.

    One is held after the other, because those that only go together become certain once one of them is held.

    Args:
        jacobian: of residuals over their noise, a column for each free parameter.
        shares: of each column, what comes from noise; see `Problem.shares_of_noise`.
        free: the parameters of its columns.
        bound: largest standard error of theta.
    """
    left = np.flatnonzero(shares <= LARGEST_SHARE).tolist()
    held = [Held(free[column], np.inf) for column in np.flatnonzero(shares > LARGEST_SHARE).tolist()]
    while left:
        errors = standard_errors(jacobian[:, left])
        worst = int(errors.argmax())
        if errors[worst] <= bound:
            break
        error = float(errors[worst]) if errors[worst] < 1e6 else np.inf
        held.append(Held(free[left.pop(worst)], error))
    return [free[column] for column in left], held


def correlated(matrix: Array) -> list[tuple[int, int, float]]:
    """Return the pairs of a covariance's rows whose correlation is high, the highest first."""
    scale = np.sqrt(np.diag(matrix))
    correlation = matrix / np.outer(scale, scale)
    pairs = np.argwhere(np.abs(np.tril(correlation, -1)) > HIGH_CORRELATION)
    found = [(int(j), int(i), float(correlation[i, j])) for i, j in pairs]
    return sorted(found, key=lambda pair: -abs(pair[2]))
