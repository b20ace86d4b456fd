"""The dispersion relation of waves: omega^2 = g k tanh(k d)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.physics.constants import GRAVITY

ITERATIONS = 8
"""Iterations of Newton's method; six reach round-off from its start."""


def wave_numbers(
    frequencies: ArrayLike, depth: float | None = None, gravity: float = GRAVITY
) -> NDArray[np.float64]:
    """Return k [rad/m] of waves of angular frequencies [rad/s], of any shape.

    Args:
        frequencies: positive.
        depth: of the water [m]; None for deep water, where k = omega^2/g.
        gravity: g [m/s^2].
    """
    omega = np.asarray(frequencies, dtype=np.float64)
    deep = omega**2 / gravity
    if depth is None:
        return deep
    # Newton's method for x = kd in x tanh x = y, from a start that is right in shallow and in deep water.
    y = deep * depth
    x = y / np.sqrt(np.tanh(y))
    for _ in range(ITERATIONS):
        t = np.tanh(x)
        x = x - (x * t - y) / (t + x * (1.0 - t * t))
    return np.asarray(x / depth)
