"""Lines of angles in a picture, which go from one end of their range to the other where the angle goes on."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def broken_at_jumps(abscissa: Array, angle: Array, *, turn: float = 2.0 * math.pi) -> tuple[Array, Array]:
    """Return a line with a gap wherever an angle jumps by more than half a turn: that is no motion.

    Args:
        abscissa: such as the time, shape (n,).
        angle: within a range of one turn, shape (n,).
        turn: in the unit of the angle.

    Returns:
        Both with NaN where the gaps are, shape (n + gaps,) each.
    """
    jumps = np.flatnonzero(np.abs(np.diff(angle)) > 0.5 * turn) + 1
    gaps = np.full(len(jumps), np.nan)
    return np.insert(abscissa, jumps, gaps), np.insert(angle, jumps, gaps)
