"""Where points are, seen from a vehicle that has moved on."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def carried(points: Array, way: Sequence[float], turn: float) -> Array:
    """Return points as a level vehicle has them that has gone on.

    Args:
        points: ahead and to starboard, and below where there are three of them, shape (n, 2) or (n, 3) [m].
        way: how far the vehicle has gone along each [m].
        turn: by how much it has then turned to starboard [rad].
    """
    c, s = math.cos(turn), math.sin(turn)
    off = points - np.array(way)
    ahead, starboard = off[:, 0], off[:, 1]
    return np.column_stack([c * ahead + s * starboard, c * starboard - s * ahead, off[:, 2:]])
