"""A straight track over the ground from the origin, seen from above."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.level import Level, level_cross, level_dot
from dq_marine.algebra.quaternion import rotate
from dq_marine.integrator.body import Motion


class OnTrack(NamedTuple):
    """A vehicle beside a track: how far along and to starboard of it [m], and its speed along it [m/s]."""

    along: float
    starboard: float
    speed: float


def on_track(course: Level, motion: Motion) -> OnTrack:
    """Return where a vehicle is beside the track from the origin along a unit vector."""
    place, over_ground = motion.position_ned, rotate(motion.attitude, motion.velocity.linear)
    return OnTrack(
        level_dot(course, (place[0], place[1])),
        level_cross(course, (place[0], place[1])),
        level_dot(course, (over_ground[0], over_ground[1])),
    )
