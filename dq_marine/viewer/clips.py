"""The motion of things as animation clips, which the page of a replay plays: a keyframe at each recorded time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import FloatArray
from dq_marine.viewer.transport.messages import Message, set_animation
from dq_marine.viewer.transport.three_json import Json, packed_floats
from dq_marine.viewer.world.drawing import JUMPING_PATHS

STEPWISE = 2300
LINEAR = 2301
"""three.js' names for ways from one keyframe to the next; it turns attitudes by slerp."""


def moving_clips(
    frames: Sequence[Mapping[str, Placement]], times: FloatArray, jumping: frozenset[str] = JUMPING_PATHS
) -> list[Json]:
    """Return clips of the things that move.

    Args:
        frames: where each thing stands, by path, the same paths at each time.
        times: of the frames [s], shape (n,), increasing; the animation begins at the first.
        jumping: paths of things that are not to be seen on their way from one frame to the next.
    """
    return [
        {"path": path, "clip": _clip(path, [frame[path] for frame in frames], times, path in jumping)}
        for path in frames[0]
        if any(frame[path] != frames[0][path] for frame in frames)
    ]


def animation(clips: Sequence[Json]) -> list[Message]:
    """Return the message that has the page play clips over and over; none where nothing moves."""
    return [set_animation(clips, play=True)] if clips else []


def _clip(path: str, placements: Sequence[Placement], times: FloatArray, jumps: bool) -> Json:
    """The motion of one thing as a three.js animation clip, from time zero on."""
    manner = STEPWISE if jumps else LINEAR
    positions = np.array([placement.position for placement in placements])
    attitudes = _continuous(np.array([placement.quaternion for placement in placements]))
    scales = np.array([[placement.scale] * 3 for placement in placements])
    tracks = [
        _track("position", "vector3", times, positions, manner),
        # three.js puts the scalar part last.
        _track("quaternion", "quaternion", times, np.roll(attitudes, -1, axis=1), manner),
        _track("scale", "vector3", times, scales, manner),
    ]
    # At one frame per second the times are in seconds.
    return {"name": path, "fps": 1, "tracks": tracks}


def _track(name: str, kind: str, times: FloatArray, values: FloatArray, manner: int) -> Json:
    return {
        "name": f".{name}",
        "type": kind,
        "times": packed_floats(times - times[0]),
        "values": packed_floats(values),
        "interpolation": manner,
    }


def _continuous(quaternions: FloatArray) -> FloatArray:
    """Quaternions, shape (n, 4), with signs such that neighbours are never more than 90 deg apart."""
    dots = np.sum(quaternions[1:] * quaternions[:-1], axis=1)
    flips = np.where(dots < 0.0, -1.0, 1.0)
    signs = np.concatenate([[1.0], np.cumprod(flips)])
    continuous: FloatArray = signs[:, None] * quaternions
    return continuous
