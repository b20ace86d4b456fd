"""Where points are, seen from a vehicle that has moved on."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import YAW, Attitude
from dq_marine.algebra.vector3 import Vector3

Array = NDArray[np.float64]


class Gone(NamedTuple):
    """How far a vehicle has gone ahead, to starboard and down [m], and then turned to starboard [rad]."""

    way: Vector3
    turn: float


def gone(attitude: Attitude, time: float) -> Gone:
    """Return how far a vehicle has gone in a time [s] as it goes now."""
    ahead, starboard, down = attitude.velocity_level
    return Gone((time * ahead, time * starboard, time * down), time * float(attitude.velocity_body[YAW]))


def carried(points: Array, way: Vector3, turn: float) -> Array:
    """Return points as a level vehicle has them that has gone on.

    Args:
        points: ahead and to starboard, and below where there are three of them, shape (n, 2) or (n, 3) [m].
        way: how far the vehicle has gone ahead, to starboard and down [m].
        turn: by how much it has then turned to starboard [rad].
    """
    c, s = math.cos(turn), math.sin(turn)
    off = points - np.array(way[: points.shape[1]])
    ahead, starboard = off[:, 0], off[:, 1]
    return np.column_stack([c * ahead + s * starboard, c * starboard - s * ahead, off[:, 2:]])
