"""Where a partner is by circles of position alone: where they meet best.

It is on the newest circle, as near to all others as their errors say. Where the circles leave two places open, or
more, as those of ranges along a straight way do, it is the one more to the bow's starboard side: who always tries the
same one finds out by its turn, and who goes between them never does.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RANGE_ERROR, DRIFT = 0.2, 0.015
"""Standard deviation of ranges [m], and by age of circles, which are advanced by velocities that err [m/s]."""

FARTHEST = 25.0
"""Squared errors over their variance count as no more: those far from where the others meet do not decide."""

PREFERRED, PREFERENCE = math.radians(45.0), 0.5
"""Bearing that is preferred [rad], and how much likelier it is than others, in the logarithm."""

BEARINGS, STEPS = 16, 6
"""Places on the newest circle from which places are sought; and steps of Gauss's and Newton's method to each."""

AT_FIRST = 0.05
"""What each step of this method holds against moving at all [1/m^2]: circles that coincide leave places open."""

_BEARINGS = np.linspace(-math.pi, math.pi, BEARINGS, endpoint=False)
_ROUND = np.stack([np.cos(_BEARINGS), np.sin(_BEARINGS)], axis=-1)


def circle_fix(centres: Array, radii: Array, ages: Array) -> Array:
    """Return where the partner is, ahead and to starboard [m], shape (2,).

    Args:
        centres: of the circles, the newest first, likewise, shape (n, 2).
        radii: [m], shape (n,).
        ages: [s], shape (n,).
    """
    variances = RANGE_ERROR**2 + (DRIFT * ages) ** 2
    places = centres[0] + radii[0] * _ROUND
    for _ in range(STEPS):
        places = places - _step(places, centres, radii, variances)
    _, off = _ways_and_errors(places, centres, radii)
    likely = -0.5 * np.minimum(off * off / variances, FARTHEST).sum(axis=1)
    preferred = np.cos(np.arctan2(places[:, 1], places[:, 0]) - PREFERRED)
    best: Array = places[int(np.argmax(likely + PREFERENCE * preferred))]
    return best


def _ways_and_errors(places: Array, centres: Array, radii: Array) -> tuple[Array, Array]:
    """Return unit vectors from centres to places, shape (m, n, 2), and how far these are off the circles, (m, n)."""
    ways = places[:, None] - centres
    lengths = np.maximum(np.sqrt(ways[..., 0] ** 2 + ways[..., 1] ** 2), 1e-6)
    return ways / lengths[..., None], lengths - radii


def _step(places: Array, centres: Array, radii: Array, variances: Array) -> Array:
    """Return by how much a step of Gauss's and Newton's method moves places, shape (m, 2)."""
    ways, off = _ways_and_errors(places, centres, radii)
    x, y = ways[..., 0], ways[..., 1]
    weights = 1.0 / variances
    a, b, c = (x * x) @ weights + AT_FIRST, (x * y) @ weights, (y * y) @ weights + AT_FIRST
    p, q = (x * off) @ weights, (y * off) @ weights
    return np.stack([c * p - b * q, a * q - b * p], axis=-1) / (a * c - b * b)[:, None]
