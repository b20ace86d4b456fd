"""Fossen's Euler angles."""

from __future__ import annotations

import math

from dq_marine.algebra.quaternion import Quaternion, quaternion_multiply


def quaternion_from_euler(roll: float, pitch: float, heading: float) -> Quaternion:
    """Return the attitude of Fossen's Euler angles (zyx) [rad], body to world."""
    about_x = (math.cos(0.5 * roll), math.sin(0.5 * roll), 0.0, 0.0)
    about_y = (math.cos(0.5 * pitch), 0.0, math.sin(0.5 * pitch), 0.0)
    about_z = (math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading))
    return quaternion_multiply(about_z, quaternion_multiply(about_y, about_x))
