"""A recorded motion as a video file (MP4, H.264), drawn picture by picture without any display."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_ending, check_folder, replacing_file
from dq_marine.viewer.between import at_even_times, picture_count
from dq_marine.viewer.encoder import Encoder, find_ffmpeg
from dq_marine.viewer.libraries import drawing_library
from dq_marine.viewer.offscreen import LARGEST_SIDE, OffscreenViewer
from dq_marine.viewer.replay import checked_times
from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.browser import find_chromium
from dq_marine.viewer.world.drawing import checked_floor_depth, floor_below

WIDTH, HEIGHT = 960, 720
"""Of the pictures, unless told otherwise [pixels]."""

SLOWEST, FASTEST = 0.1, 120.0
"""Pictures a second."""

SMOOTH = 60.0
"""Pictures a second that are enough, where nobody asks for more."""


def save_video(
    path: str | os.PathLike[str],
    snapshots: Sequence[Snapshot],
    shape: Shape,
    *,
    fps: float | None = None,
    width: int = WIDTH,
    height: int = HEIGHT,
    floor_depth: float | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> None:
    """Write a video that runs in real time.

    The file appears complete or not at all; an older one of the same name is replaced.

    Args:
        path: of the MP4 file; its folder must exist.
        snapshots: one or more, in the order of increasing time.
        shape: the vehicle.
        fps: pictures a second; between snapshots the motion goes on evenly. None shows each snapshot once, up to
            `SMOOTH` a second.
        width: of the pictures [pixels], even.
        height: of the pictures [pixels], even.
        floor_depth: depth of the sea floor [m]; None puts one below everything in the video.
        progress: is told what part is done, from 0 to 1.

    Raises:
        InvalidInputError: no snapshots, times that do not increase, a rate or size that cannot be, or a path that
            cannot be written.
        MissingDependencyError: a library of the viewer, imageio-ffmpeg, or Chromium is not installed.
        ViewerError: a picture could not be drawn, or the video not be written.
    """
    target = Path(path)
    check_video(target, fps)
    for name, pixels in (("width", width), ("height", height)):
        if pixels % 2 or not 2 <= pixels <= LARGEST_SIDE:
            raise InvalidInputError(f"{name} is {pixels}; give an even number of pixels, 2 to {LARGEST_SIDE}")
    times = checked_times(snapshots)
    if floor_depth is None:
        floor_depth = floor_below(snapshots, shape)
    rate = fps or min(SMOOTH, _rate_of(times.tolist()))
    count = picture_count(snapshots, rate)
    with (
        replacing_file(target) as temporary,
        OffscreenViewer(
            shape, width, height, floor_depth=checked_floor_depth(floor_depth), smooth=True
        ) as viewer,
        Encoder(temporary, width, height, rate) as encoder,
    ):
        for number, snapshot in enumerate(at_even_times(snapshots, rate), start=1):
            encoder.add(viewer.render(snapshot))
            progress(number / count)


def check_video(path: Path, fps: float | None = None) -> None:
    """Check that a video can be drawn and written, before there is anything to show.

    Raises:
        InvalidInputError: the ending is not .mp4, the folder does not exist, or a rate that videos do not have.
        MissingDependencyError: a library of the viewer, imageio-ffmpeg, or Chromium is not installed.
    """
    check_ending(path, ".mp4")
    if path.is_dir():
        raise InvalidInputError(f"{path} is a folder; give the path of a file in it")
    check_folder(path)
    if fps is not None and not (math.isfinite(fps) and SLOWEST <= fps <= FASTEST):
        raise InvalidInputError(f"fps = {fps:g}; give {SLOWEST:g} to {FASTEST:g} pictures a second")
    drawing_library("PIL.Image")
    find_ffmpeg()
    find_chromium()


def _rate_of(times: list[float]) -> float:
    """Return snapshots a second; any will do for a single one."""
    return (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 else 1.0
