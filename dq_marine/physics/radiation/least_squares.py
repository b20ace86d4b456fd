"""Least squares with outliers, by the method of Levenberg and Marquardt.

SciPy's does the same, but by singular values of a few hundred rows, which BLAS shares out among threads: on a busy
machine that took a hundred times as long as the fit does here, where no product is large enough to be shared out.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FIRST_DAMPING, EASED, STIFFENED = 1e-2, 1.0 / 3.0, 4.0
"""Levenberg's damping at the start, and what it is multiplied by after a step that helped, and one that did not."""

LARGEST_DAMPING = 1e8
"""With which a step that does not help ends the search."""


def robust_least_squares(
    residuals: Callable[[Array], Array],
    slopes: Callable[[Array], Array],
    start: Array,
    *,
    outlying: float,
    settled: float,
    evaluations: int,
) -> Array:
    """Return unknowns with a least sum of 2 c^2 (sqrt(1 + (r/c)^2) - 1), the soft L1 loss, near the start.

    Args:
        residuals: (unknowns) -> r, shape (k,).
        slopes: (unknowns) -> their derivative, shape (k, unknowns).
        start: shape (unknowns,).
        outlying: c, the size from which a residual counts less than its square.
        settled: relative change of the sum at which the search ends.
        evaluations: of the residuals, at most.
    """
    unknowns, damping = start, FIRST_DAMPING
    left = residuals(unknowns)
    loss, done = soft_l1(left, outlying), 1
    while done < evaluations and damping < LARGEST_DAMPING:
        weights = 1.0 / np.sqrt(1.0 + (left / outlying) ** 2)
        derivative = slopes(unknowns)
        gradient = derivative.T @ (weights * left)
        curvature = np.einsum("ki,kj->ij", derivative * weights[:, None], derivative)
        while done < evaluations and damping < LARGEST_DAMPING:
            stiff = curvature + damping * np.diag(np.maximum(np.diag(curvature), np.finfo(float).tiny))
            tried = unknowns - np.linalg.solve(stiff, gradient)
            left_there = residuals(tried)
            loss_there, done = soft_l1(left_there, outlying), done + 1
            if loss_there < loss:
                break
            damping *= STIFFENED
        else:
            return unknowns
        gained, unknowns, left, loss = loss - loss_there, tried, left_there, loss_there
        damping *= EASED
        if gained <= settled * loss:
            break
    return unknowns


def soft_l1(left: Array, outlying: float) -> float:
    """Return the sum of the soft L1 loss of residuals."""
    return float(np.sum(2.0 * outlying**2 * (np.sqrt(1.0 + (left / outlying) ** 2) - 1.0)))
