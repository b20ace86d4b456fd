"""When a sampled quantity passes a value, and what others are then: linear between samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def first_time_at(time: Array, values: Array, level: float) -> float | None:
    """Return when values first reach a level from below [s]; None if they do not.

    Args:
        time: increasing, shape (n,).
        values: shape (n,).
        level: what they reach.
    """
    reached = np.flatnonzero(values >= level)
    if not reached.size:
        return None
    after = int(reached[0])
    if after == 0:
        return float(time[0])
    low, high = float(values[after - 1]), float(values[after])
    share = (level - low) / (high - low)
    return float(time[after - 1] + share * (time[after] - time[after - 1]))


def value_at(time: Array, values: Array, moment: float | None) -> float | None:
    """Return a sampled quantity at a moment; None at none."""
    return None if moment is None else float(np.interp(moment, time, values))
