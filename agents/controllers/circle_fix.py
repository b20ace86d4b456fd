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
"""Places on the newest circle from which the best is sought, and steps of Gauss's and Newton's method from each."""

AT_FIRST = 1.0
"""What each step of this method holds against moving at all: circles that coincide leave all bearings open."""

_BEARINGS = np.linspace(-math.pi, math.pi, BEARINGS, endpoint=False)
_FARTHEST_STEP = math.pi / BEARINGS


def circle_fix(centres: Array, radii: Array, ages: Array) -> Array:
    """Return where the partner is, ahead and to starboard [m], shape (2,).

    Args:
        centres: of the circles, the newest first, likewise, shape (n, 2).
        radii: [m], shape (n,).
        ages: [s], shape (n,).
    """
    weights = 1.0 / (RANGE_ERROR**2 + (DRIFT * ages) ** 2)
    bearings = _BEARINGS
    for _ in range(STEPS):
        along, off, slope = _off_circles(bearings, centres, radii)
        step = (off * slope) @ weights / ((slope * slope) @ weights + AT_FIRST)
        bearings = bearings - np.clip(step, -_FARTHEST_STEP, _FARTHEST_STEP)
    along, off, _ = _off_circles(bearings, centres, radii)
    likely = -0.5 * np.minimum(off * off * weights, FARTHEST).sum(axis=1)
    places = centres[0] + radii[0] * along
    preferred = np.cos(np.arctan2(places[:, 1], places[:, 0]) - PREFERRED)
    best: Array = places[int(np.argmax(likely + PREFERENCE * preferred))]
    return best


def _off_circles(bearings: Array, centres: Array, radii: Array) -> tuple[Array, Array, Array]:
    """Return for places on the newest circle what tells how far they are off all circles.

    Args:
        bearings: of the places from its centre [rad], shape (m,).
        centres: of the circles, as for `circle_fix`.
        radii: likewise.

    Returns:
        Unit vectors to the places, shape (m, 2); how far they are off [m], and by how much more per radian, (m, n).
    """
    along = np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
    ways = (centres[0] + radii[0] * along)[:, None] - centres
    lengths = np.maximum(np.hypot(ways[..., 0], ways[..., 1]), 1e-6)
    across = along[:, None, 0] * ways[..., 1] - along[:, None, 1] * ways[..., 0]
    return along, lengths - radii, radii[0] * across / lengths
