"""A hull over the ground: its altitude, its clearance, and the speed at which it strikes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.selection import select
from dq_marine.algebra.vector3 import Vector3, add_scaled, norm
from dq_marine.integrator.body import Motion


class Keel(NamedTuple):
    """A hull seen from the side: half its length and half its height [m]."""

    half_length: float
    half_height: float


class KeelOver(NamedTuple):
    """A vehicle over the ground.

    Attributes:
        altitude: of its origin, straight up from the ground [m].
        clearance: of its hull, likewise: less than 0 in contact [m].
        impact_speed: over ground in contact, else 0 [m/s].
    """

    altitude: float
    clearance: float
    impact_speed: float


def make_keel_over(
    depth: Callable[[Any, float, float], float],
) -> Callable[[Any, Motion, Keel], KeelOver]:
    """Return (ground, motion, keel) -> where a vehicle is over the ground.

    The clearance is the least height of bow, middle and stern above the ground, less half the hull's height.

    Args:
        depth: (ground, north, east) -> depth of the ground there [m].
    """

    def height(ground: Any, point: Vector3) -> float:
        return depth(ground, point[0], point[1]) - point[2]

    def keel_over(ground: Any, motion: Motion, keel: Keel) -> KeelOver:
        place, ahead = motion.position_ned, rotate(motion.attitude, (1.0, 0.0, 0.0))
        altitude = height(ground, place)
        bow = height(ground, add_scaled(place, keel.half_length, ahead))
        stern = height(ground, add_scaled(place, -keel.half_length, ahead))
        clearance = min(altitude, min(bow, stern)) - keel.half_height
        return KeelOver(altitude, clearance, select(clearance < 0.0, norm(motion.velocity.linear), 0.0))

    return keel_over
