"""A video has all pictures, at its rate, is whole or not there, and is refused before anything is drawn."""

from __future__ import annotations

import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from viewer.samples import ROV, snapshot

from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.viewer import Snapshot, ViewerError, save_video
from dq_marine.viewer.video import check_video

SIZE = (160, 120)


def leaving(count: int = 5) -> list[Snapshot]:
    """Recorded ten times a second."""
    return [snapshot(time=0.1 * i, position_ned=[0.0, 0.06 * i, 5.0]) for i in range(count)]


def seen(path: Path) -> np.ndarray:
    """The pictures of a video, shape (n, height, width, 3)."""
    command = [
        imageio_ffmpeg.get_ffmpeg_exe(),
        "-v",
        "error",
        "-i",
        str(path),
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
    ]
    read = subprocess.run([*command, "-"], capture_output=True, check=True).stdout
    return np.frombuffer(read, np.uint8).reshape(-1, SIZE[1], SIZE[0], 3).astype(int)


def said_of(path: Path) -> str:
    """What ffmpeg says of a video."""
    return subprocess.run(
        [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path)], capture_output=True, text=True
    ).stderr


def least_change(pictures: np.ndarray) -> float:
    """The mean change of a colour from one picture to the next, where that is least."""
    return float(min(np.abs(now - then).mean() for then, now in pairwise(pictures)))


@pytest.mark.browser
def test_every_picture_is_there_and_the_vehicle_moves(tmp_path: Path) -> None:
    told: list[float] = []
    path = tmp_path / "leaving.mp4"
    save_video(path, leaving(), ROV, width=SIZE[0], height=SIZE[1], progress=told.append)
    pictures = seen(path)
    assert len(pictures) == 5
    assert least_change(pictures) > 0.2
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    assert re.search(r"h264.*yuv420p.*160x120.* 10 fps", said_of(path))

    save_video(path, leaving(3), ROV, fps=20.0, width=SIZE[0], height=SIZE[1])
    pictures = seen(path)
    assert len(pictures) == 5
    assert least_change(pictures) > 0.1, "it moves between the snapshots, too"
    assert " 20 fps" in said_of(path)


class Blank:
    """Stands in for the viewer that draws."""

    def __init__(self, *_: object, **__: object) -> None:
        pass

    def __enter__(self) -> Blank:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def render(self, _: Snapshot) -> np.ndarray:
        return np.zeros((SIZE[1], SIZE[0], 3), np.uint8)


@pytest.fixture
def blank(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dq_marine.viewer.video.OffscreenViewer", Blank)
    monkeypatch.setattr("dq_marine.viewer.video.find_chromium", lambda: "none")


@pytest.mark.usefixtures("blank")
@pytest.mark.parametrize(
    ("end", "why"),
    [("echo all is lost >&2; exit 3", "all is lost"), ("cat > /dev/null; exit 1", "did not say why")],
    ids=["at once", "at the end"],
)
def test_a_failing_ffmpeg_leaves_the_old_file(
    end: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken, path = tmp_path / "broken", tmp_path / "leaving.mp4"
    path.write_text("old")
    broken.write_text(f"#!/bin/sh\n{end}\n")
    broken.chmod(0o755)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(broken))
    with pytest.raises(ViewerError, match=f"ffmpeg did not write the video: .*{why}"):
        save_video(path, leaving(100), ROV, width=SIZE[0], height=SIZE[1])
    assert path.read_text() == "old"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["broken", "leaving.mp4"]


@pytest.mark.usefixtures("blank")
def test_an_interrupted_video_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "leaving.mp4"
    path.write_text("old")

    def interrupt(done: float) -> None:
        if done > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        save_video(path, leaving(), ROV, width=SIZE[0], height=SIZE[1], progress=interrupt)
    assert path.read_text() == "old"
    assert [one.name for one in tmp_path.iterdir()] == ["leaving.mp4"]


@pytest.mark.browser
@pytest.mark.parametrize(
    "changes", [{"width": 101}, {"height": 0}, {"fps": 0.0}, {"fps": float("nan")}, {"fps": 1e3}]
)
def test_sizes_and_rates_that_cannot_be_are_refused(changes: dict[str, float], tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=next(iter(changes))):
        save_video(tmp_path / "video.mp4", leaving(), ROV, **changes)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_paths_that_cannot_be_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"ends in \.mp4"):
        check_video(tmp_path / "video.avi")
    with pytest.raises(InvalidInputError, match="does not exist"):
        check_video(tmp_path / "absent" / "video.mp4")
    (tmp_path / "folder.mp4").mkdir()
    with pytest.raises(InvalidInputError, match="is a folder"):
        check_video(tmp_path / "folder.mp4")


def test_a_missing_library_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(MissingDependencyError, match=r"'imageio_ffmpeg'.*dq-marine\[video\]"):
        check_video(tmp_path / "video.mp4")


def test_a_missing_program_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def absent() -> str:
        raise RuntimeError("No ffmpeg exe could be found.")

    monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", absent)
    with pytest.raises(MissingDependencyError, match="IMAGEIO_FFMPEG_EXE"):
        check_video(tmp_path / "video.mp4")
