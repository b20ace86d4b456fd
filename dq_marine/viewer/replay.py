"""A recorded motion as one HTML file that plays by itself, without a server or a network."""

from __future__ import annotations

import base64
import html
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_folder, write_whole
from dq_marine.viewer.framed import framed
from dq_marine.viewer.libraries import meshcat_page_folder
from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_animation, set_transform
from dq_marine.viewer.transport.pages import REPLAY_PAGE
from dq_marine.viewer.transport.three_json import Json, packed_floats
from dq_marine.viewer.world.beams import draw_beams
from dq_marine.viewer.world.drawing import JUMPING_PATHS, Drawing, checked_floor_depth, floor_below
from dq_marine.viewer.world.trail import draw_trail

STEPWISE = 2300
LINEAR = 2301
"""three.js' names for ways from one keyframe to the next; it turns attitudes by slerp."""


@dataclass(frozen=True)
class Replay:
    """A recorded motion as one page that plays by itself; a notebook shows it where it is the last value of a cell.

    Attributes:
        page: HTML, with all that it needs.
    """

    page: str = field(repr=False)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page: open it in any browser, play, pause, and drag the slider.

        The file appears complete or not at all; an older one of the same name is replaced.

        Args:
            path: of the HTML file; its folder must exist.

        Raises:
            InvalidInputError: the path cannot be written.
        """
        write_whole(_checked_target(Path(path)), self.page)

    def _repr_html_(self) -> str:
        return framed(self.page)


def save_replay(
    path: str | os.PathLike[str],
    snapshots: Sequence[Snapshot],
    shape: Shape,
    *,
    floor_depth: float | None = None,
    title: str = "dq-marine",
) -> None:
    """Write a replay: open it in any browser, play, pause, and drag the slider.

    The file appears complete or not at all; an older one of the same name is replaced.

    Args:
        path: of the HTML file; its folder must exist.
        snapshots: see `make_replay` for these and the others.
        shape: the vehicle.
        floor_depth: depth of the sea floor [m].
        title: above the clock.

    Raises:
        InvalidInputError: see `make_replay`; or the path cannot be written.
        MissingDependencyError: meshcat is not installed.
    """
    target = _checked_target(Path(path))
    make_replay(snapshots, shape, floor_depth=floor_depth, title=title).save(target)


def make_replay(
    snapshots: Sequence[Snapshot], shape: Shape, *, floor_depth: float | None = None, title: str = "dq-marine"
) -> Replay:
    """Return a replay.

    Args:
        snapshots: one or more, in the order of increasing time.
        shape: the vehicle.
        floor_depth: depth of the sea floor [m]; None puts one below everything in the replay.
        title: plain text, shown above the clock.

    Raises:
        InvalidInputError: no snapshots, times that do not increase, or a `floor_depth` not above 0.
        MissingDependencyError: meshcat is not installed.
    """
    times = checked_times(snapshots)
    if floor_depth is None:
        floor_depth = floor_below(snapshots, shape)
    messages = _messages(snapshots, times, shape, Drawing(shape, checked_floor_depth(floor_depth)))
    return Replay(
        REPLAY_PAGE.substitute(
            title=html.escape(title),
            # A script ends at the first closing tag, wherever that stands.
            meshcat=_meshcat_script().replace("</script", "<\\/script"),
            messages=json.dumps([base64.b64encode(c.packed()).decode() for c in messages]),
            times=json.dumps(times.tolist()),
        )
    )


def _checked_target(path: Path) -> Path:
    if path.is_dir():
        raise InvalidInputError(f"{path} is a folder; give the path of a file in it")
    check_folder(path)
    return path


def checked_times(snapshots: Sequence[Snapshot]) -> FloatArray:
    """The times of the snapshots [s].

    Raises:
        InvalidInputError: there are none, or they do not increase.
    """
    if not snapshots:
        raise InvalidInputError("there are 0 snapshots; give at least 1: record some first")
    times = np.array([snapshot.time for snapshot in snapshots])
    stuck = np.flatnonzero(np.diff(times) <= 0.0)
    if len(stuck):
        at = int(stuck[0])
        raise InvalidInputError(
            f"snapshot {at + 1} has time {times[at + 1]:g} s, which is not after the {times[at]:g} s "
            "of the one before; times must increase: write one file for each episode"
        )
    return times


def _messages(
    snapshots: Sequence[Snapshot], times: FloatArray, shape: Shape, drawing: Drawing
) -> list[Message]:
    """Everything the page has to do: draw, place, animate."""
    messages = drawing.scenery(snapshots[0])
    for snapshot in snapshots:
        messages += drawing.appear(snapshot)
    frames = [drawing.placements(snapshot) for snapshot in snapshots]
    messages += draw_beams(snapshots, shape)
    messages.append(draw_trail(np.array([snapshot.position_ned for snapshot in snapshots]), times))
    messages += [set_transform(path, placement) for path, placement in frames[0].items()]
    clips = [
        {"path": path, "clip": _clip(path, [frame[path] for frame in frames], times)}
        for path in frames[0]
        if any(frame[path] != frames[0][path] for frame in frames)
    ]
    if clips:
        messages.append(set_animation(clips, play=True))
    return messages


def _clip(path: str, placements: Sequence[Placement], times: FloatArray) -> Json:
    """The motion of one thing as a three.js animation clip, from time zero on."""
    manner = STEPWISE if path in JUMPING_PATHS else LINEAR
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


def _meshcat_script() -> str:
    return (meshcat_page_folder() / "main.min.js").read_text(encoding="utf-8")
