"""A recorded motion as one HTML file that plays by itself, without a server or a network."""

from __future__ import annotations

import base64
import html
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_folder, write_whole
from dq_marine.viewer.clips import animation, moving_clips
from dq_marine.viewer.framed import framed
from dq_marine.viewer.libraries import meshcat_page_folder
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_transform
from dq_marine.viewer.transport.pages import REPLAY_PAGE
from dq_marine.viewer.transport.three_json import Json
from dq_marine.viewer.world.beams import draw_beams
from dq_marine.viewer.world.drawing import Drawing, checked_floor_depth, floor_below
from dq_marine.viewer.world.trail import TRAIL_YELLOW, draw_trail


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
        write_whole(checked_target(Path(path)), self.page)

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
    target = checked_target(Path(path))
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
    messages, clips = staged(snapshots, times, Drawing(shape, checked_floor_depth(floor_depth)))
    messages += [*draw_beams(snapshots, shape), *animation(clips)]
    page = filled(REPLAY_PAGE, title, messages, times=script_json(times.tolist()))
    return Replay(page)


def filled(page: Template, title: str, messages: Sequence[Message], **data: str) -> str:
    """Return the page of a replay with all that it needs.

    Args:
        page: with places for a title, meshcat, messages and data.
        title: plain text.
        messages: what the page does, in their order.
        data: further JavaScript, by its place in the page.
    """
    return page.substitute(
        title=html.escape(title),
        # A script ends at the first closing tag, wherever that stands.
        meshcat=_meshcat_script().replace("</script", "<\\/script"),
        messages=script_json([base64.b64encode(one.packed()).decode() for one in messages]),
        **data,
    )


def script_json(content: Any) -> str:
    """Return content as JavaScript in a page, where no text of it can end the script.

    Raises:
        ValueError: there is a number that is not finite in it.
    """
    return json.dumps(content, allow_nan=False).replace("<", "\\u003c")


def checked_target(path: Path) -> Path:
    """Return the path of a page to write.

    Raises:
        InvalidInputError: it is a folder, or its folder does not exist.
    """
    if path.is_dir():
        raise InvalidInputError(f"{path} is a folder; give the path of a file in it")
    check_folder(path)
    return path


def checked_times(snapshots: Sequence[Snapshot], of: str = "") -> FloatArray:
    """The times of the snapshots [s].

    Args:
        snapshots: of one motion.
        of: which motion that is, for the message.

    Raises:
        InvalidInputError: there are none, or they do not increase.
    """
    if not snapshots:
        raise InvalidInputError(f"there are 0 snapshots{of}; give at least 1: record some first")
    times = np.array([snapshot.time for snapshot in snapshots])
    stuck = np.flatnonzero(np.diff(times) <= 0.0)
    if len(stuck):
        at = int(stuck[0])
        raise InvalidInputError(
            f"snapshot {at + 1}{of} has time {times[at + 1]:g} s, which is not after the {times[at]:g} s "
            "of the one before; times must increase: write one file for each episode"
        )
    return times


def staged(
    snapshots: Sequence[Snapshot], times: FloatArray, drawing: Drawing, trail_color: int = TRAIL_YELLOW
) -> tuple[list[Message], list[Json]]:
    """Return what draws and places everything at the first snapshot, and the clips of what moves.

    Args:
        snapshots: one or more.
        times: of them [s], shape (n,).
        drawing: of a vehicle and its surroundings, that has drawn nothing yet.
        trail_color: 0xRRGGBB.
    """
    messages = drawing.scenery(snapshots[0])
    for snapshot in snapshots:
        messages += drawing.appear(snapshot)
    frames = [drawing.placements(snapshot) for snapshot in snapshots]
    track = np.array([snapshot.position_ned for snapshot in snapshots])
    messages.append(draw_trail(track, times, color=trail_color))
    messages += [set_transform(path, placement) for path, placement in frames[0].items()]
    return messages, moving_clips(frames, times)


def _meshcat_script() -> str:
    return (meshcat_page_folder() / "main.min.js").read_text(encoding="utf-8")
