"""Arrows for what acts on the vehicle: the applied force, and the current in the water around it."""

from __future__ import annotations

import math

import numpy as np

from dq_marine.viewer.meshes import revolved
from dq_marine.viewer.placement import Y_AXIS, Placement, hidden_at, rotation_between, vector3
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_object
from dq_marine.viewer.transport.three_json import Look, Painted, painted_surface

THRUST = "/world/thrust"
CURRENT = "/world/current"

THRUST_RED = 0xFF4A3A
THRUST_LOOK = Look(foggy=False)
CURRENT_WHITE = 0xE8FBFF
CURRENT_LOOK = Look(opacity=0.7)

FULL_THRUST_IN_LENGTHS = 0.9
"""Length of the thrust arrow at `Shape.max_force`, in vehicle lengths; it grows no longer."""

CURRENT_OF_ONE_LENGTH = 0.5
"""Speed of the water [m/s] whose arrow is as long as the vehicle."""

LONGEST_CURRENT_IN_LENGTHS = 2.0

FAINTEST = 0.01
"""An arrow shorter than this share of the vehicle's length is not drawn."""

CURRENT_PLACES = np.array([[1.5, 1.5, 1.0], [1.5, -1.5, 1.0], [-1.5, 1.5, 1.0], [-1.5, -1.5, 1.0]])
"""Middles of the current arrows as seen from the vehicle: north, east, down, in vehicle lengths.

They lie below the vehicle, so that none comes between it and the camera above it.
"""


CURRENT_PATHS = [f"{CURRENT}/{number}" for number in range(len(CURRENT_PLACES))]


def draw_arrows() -> list[Message]:
    """All arrows, one unit long along y, to be turned and scaled by their placements."""
    return [
        _arrow(THRUST, THRUST_RED, THRUST_LOOK, thickness=0.04, tail=0.0),
        *(_arrow(path, CURRENT_WHITE, CURRENT_LOOK, 0.03, tail=-0.5) for path in CURRENT_PATHS),
    ]


def thrust_placement(snapshot: Snapshot, shape: Shape, body_to_ned: FloatArray) -> Placement:
    """The arrow of the applied force: it starts at the hull and points where the force pushes.

    Args:
        snapshot: gives force and position.
        shape: gives the hull and the force of a full arrow.
        body_to_ned: rotation matrix, shape (3, 3).
    """
    force = snapshot.wrench_body[:3]
    magnitude = float(np.linalg.norm(force))
    share = min(magnitude / shape.max_force, 1.0)
    if share < FAINTEST:
        return hidden_at(vector3(snapshot.position_ned))
    direction = force / magnitude
    start = snapshot.position_ned + body_to_ned @ (direction * _hull_distance(direction, shape))
    turn = rotation_between(Y_AXIS, vector3(body_to_ned @ direction))
    return Placement(vector3(start), turn, share * FULL_THRUST_IN_LENGTHS * shape.length)


def current_placements(snapshot: Snapshot, shape: Shape) -> dict[str, Placement]:
    """The arrows of the current around the vehicle, by path."""
    speed = float(np.linalg.norm(snapshot.current_ned))
    lengths = min(speed / CURRENT_OF_ONE_LENGTH, LONGEST_CURRENT_IN_LENGTHS)
    middles = map(vector3, snapshot.position_ned + shape.length * CURRENT_PLACES)
    if lengths < FAINTEST:
        return dict(zip(CURRENT_PATHS, map(hidden_at, middles), strict=True))
    turn = rotation_between(Y_AXIS, vector3(snapshot.current_ned))
    placements = (Placement(middle, turn, lengths * shape.length) for middle in middles)
    return dict(zip(CURRENT_PATHS, placements, strict=True))


def _arrow(path: str, color: int, look: Look, thickness: float, tail: float) -> Message:
    """Draw an arrow of length 1 along y that starts at y = `tail`."""
    shaft, head = 0.72, 0.28
    profile = [
        (0.0, tail),
        (thickness, tail),
        (thickness, tail + shaft),
        (2.6 * thickness, tail + shaft),
        (0.0, tail + shaft + head),
    ]
    return set_object(path, painted_surface(path, [Painted(revolved(profile), color)], look))


def _hull_distance(direction: FloatArray, shape: Shape) -> float:
    """From the vehicle's origin to the ellipsoid around it [m], along a unit vector in body axes."""
    half_axes = np.array([shape.length, shape.width, shape.height]) / 2
    return 1.0 / math.hypot(*(direction / half_axes))
