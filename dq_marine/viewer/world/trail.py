"""The line of past positions behind the vehicle."""

from __future__ import annotations

from collections import deque

import numpy as np

from dq_marine.viewer.snapshot import FloatArray
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import packed_floats, polyline

TRAIL = "/world/trail"
TRAIL_YELLOW = 0xFFE66D

LONGEST = 2000
"""Positions that are remembered; the oldest are forgotten first."""


class Trail:
    """A bounded memory of where the vehicle was."""

    def __init__(self, spacing: float) -> None:
        """Start empty.

        Args:
            spacing: a position closer than this to the last one [m] is not remembered.
        """
        self._spacing = spacing
        self._positions: deque[FloatArray] = deque(maxlen=LONGEST)
        self._times: deque[float] = deque(maxlen=LONGEST)

    def restart(self) -> None:
        """Forget everything."""
        self._positions.clear()
        self._times.clear()

    def extend(self, position_ned: FloatArray, time: float) -> bool:
        """Remember a position [m] and its time [s]; False if it was too close to the last one."""
        if self._positions and np.linalg.norm(position_ned - self._positions[-1]) < self._spacing:
            return False
        self._positions.append(position_ned)
        self._times.append(time)
        return True

    def message(self) -> Message:
        """Draw the trail as it is now."""
        return draw_trail(np.array(self._positions), np.array(self._times))


def draw_trail(
    positions_ned: FloatArray, times: FloatArray, *, path: str = TRAIL, color: int = TRAIL_YELLOW
) -> Message:
    """Draw a line through positions, shape (n, 3) [m], and tell the page their times, shape (n,) [s]."""
    return set_object(path, polyline(path, positions_ned, color, {"times": packed_floats(times)}))
