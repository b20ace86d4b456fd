"""The camera: how it first looks at the vehicle, and how the view follows a vehicle that leaves."""

from __future__ import annotations

import math

import numpy as np

from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_object, set_property
from dq_marine.viewer.transport.three_json import bare_object

CAMERA = "/Cameras/default/rotated"
VIEW_ANGLE_DEG = 50.0
"""Vertical field of view."""

ASIDE = math.radians(55.0)
ABOVE = math.radians(22.0)
"""The camera stands behind the vehicle, turned by ASIDE to starboard and raised by ABOVE."""

NEAREST_IN_LENGTHS = 2.8
FARTHEST_IN_LENGTHS = 4.0
"""Distance of the camera from the vehicle; a far goal moves it back, to be seen as well."""

LEASH_IN_LENGTHS = 0.8


class LeashedView:
    """The point in the world that the camera looks at.

    It stays where it is while the vehicle is near, so that small motions can be seen, and is drawn
    along like a thing on a leash when the vehicle leaves.
    """

    def __init__(self, leash: float) -> None:
        """Start anywhere: the first `follow` decides.

        Args:
            leash: largest distance of the point from the vehicle [m].
        """
        self._leash = leash
        self._anchor: FloatArray | None = None

    def restart(self) -> None:
        """Jump to the vehicle at the next `follow`."""
        self._anchor = None

    def follow(self, position_ned: FloatArray) -> FloatArray:
        """The point to look at [m], NED, now that the vehicle is at `position_ned`."""
        if self._anchor is None:
            self._anchor = position_ned
        offset = self._anchor - position_ned
        distance = float(np.linalg.norm(offset))
        if distance > self._leash:
            self._anchor = position_ned + offset * (self._leash / distance)
        return self._anchor


def place_camera(first: Snapshot, shape: Shape, sight: float) -> list[Message]:
    """Place the camera for the first picture; afterwards the mouse may move it.

    Args:
        first: gives the direction to look in: towards the goal, or else ahead.
        shape: gives the size of the vehicle.
        sight: distance at which things vanish [m].
    """
    size = shape.size
    look, goal_distance = _look_direction(first, size)
    distance = min(max(1.2 * goal_distance, NEAREST_IN_LENGTHS * size), FARTHEST_IN_LENGTHS * size)
    behind = look + math.pi - ASIDE
    north = distance * math.cos(ABOVE) * math.cos(behind)
    east = distance * math.cos(ABOVE) * math.sin(behind)
    up = distance * math.sin(ABOVE)
    lens = bare_object(
        "PerspectiveCamera",
        fov=VIEW_ANGLE_DEG,
        aspect=4 / 3,
        near=0.02 * size,
        far=4.0 * sight,
    )
    return [
        set_object(CAMERA, lens),
        # The axes of meshcat's camera node are north, up, east.
        set_property(f"{CAMERA}/<object>", "position", [north, up, east]),
    ]


def _look_direction(first: Snapshot, size: float) -> tuple[float, float]:
    """Bearing to look in [rad from north, clockwise] and the distance of the goal [m], or 0."""
    if first.goal_position_ned is not None:
        north, east, _ = first.goal_position_ned - first.position_ned
        distance = math.hypot(north, east)
        if distance > size:
            return math.atan2(east, north), distance
    w, x, y, z = first.quaternion_body_to_ned
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)), 0.0
