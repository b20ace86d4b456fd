"""Quaternions made unit again, and the attitude after a short turn."""

from __future__ import annotations

import math

from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_dot,
    quaternion_multiply,
    quaternion_scale,
)
from dq_marine.algebra.vector3 import Vector3


def normalised(q: Quaternion) -> Quaternion:
    """Return q/|q|."""
    return quaternion_scale(1.0 / math.sqrt(quaternion_dot(q, q)), q)


def turned(attitude: Quaternion, h: float, spin: Vector3) -> Quaternion:
    """Return the attitude after h seconds at `spin` (body frame): (q + (h/2) q omega) made unit.

    That turns about the right axis, by 2 atan(h |omega|/2) instead of h |omega|: an error of third order.
    """
    half = 0.5 * h
    return normalised(quaternion_multiply(attitude, (1.0, half * spin[0], half * spin[1], half * spin[2])))
