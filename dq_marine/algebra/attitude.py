"""Fossen's Euler angles of an attitude."""

from __future__ import annotations

import math
from collections.abc import Iterable


def attitude_angles(quaternion: Iterable[float]) -> tuple[float, float, float]:
    """Return roll, pitch and heading (zyx) of one attitude body to NED [rad].

    From the entries R32 and R33, R31, R21 and R11 of the rotation matrix.

    Args:
        quaternion: unit, scalar first, four numbers.
    """
    w, x, y, z = quaternion
    return (
        math.atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
        math.asin(min(max(2.0 * (w * y - x * z), -1.0), 1.0)),
        math.atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z)),
    )
