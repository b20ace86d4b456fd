"""A vehicle and snapshots of it, for the viewer's tests."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dq_marine.viewer.snapshot import Shape, Snapshot, Thruster

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])

ROV = Shape(
    length=0.457,
    width=0.436,
    height=0.254,
    thrusters=(Thruster(np.array([0.15, 0.1, 0.0]), np.array([1.0, -1.0, 0.0])),),
    max_force=80.0,
)
AUV = Shape(length=1.33, width=0.19, height=0.19, max_force=20.0, kind="torpedo")


def yawed(angle: float) -> np.ndarray:
    """A turn to starboard [rad] as a quaternion."""
    return np.array([math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)])


def snapshot(**changes: Any) -> Snapshot:
    """A vehicle at rest, five metres down, with the given changes."""
    plain: dict[str, Any] = {
        "time": 0.0,
        "position_ned": np.array([0.0, 0.0, 5.0]),
        "quaternion_body_to_ned": UPRIGHT,
        "wrench_body": np.zeros(6),
        "current_ned": np.zeros(3),
    }
    return Snapshot(**{**plain, **changes})
