"""Pictures into a video file (MP4, H.264) by ffmpeg, which the package imageio-ffmpeg brings along."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import MissingDependencyError
from dq_marine.util.extras import optional_library
from dq_marine.viewer.errors import ViewerError

RATE_FACTOR = 20
"""Of H.264: what it may lose; blocks in the water's even colours are not seen yet."""


def find_ffmpeg() -> str:
    """Return the path of the program: that of imageio-ffmpeg, or the one that IMAGEIO_FFMPEG_EXE names.

    Raises:
        MissingDependencyError: imageio-ffmpeg is not installed, or has no program for this platform.
    """
    try:
        found: str = optional_library("writing a video", "imageio_ffmpeg", "video").get_ffmpeg_exe()
    except RuntimeError as error:
        raise MissingDependencyError(
            "writing a video needs the program ffmpeg, and imageio-ffmpeg finds none; install it, or let "
            "IMAGEIO_FFMPEG_EXE name it"
        ) from error
    return found


class Encoder:
    """A video under way, within a `with` block; at the end of it the file is whole."""

    def __init__(self, path: Path, width: int, height: int, rate: float) -> None:
        """Start ffmpeg.

        Args:
            path: of the file, which is replaced.
            width: of the pictures [pixels], even.
            height: of the pictures [pixels], even.
            rate: pictures a second.

        Raises:
            MissingDependencyError: there is no ffmpeg.
            ViewerError: it cannot be started.
        """
        raw = [
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-s",
            f"{width}x{height}",
            "-r",
            f"{rate:.9g}",
            "-i",
            "-",
        ]
        # Half the resolution in colour, because players know nothing else; the table of contents first, so that a
        # page can play the file while it loads.
        coded = [
            "-c:v",
            "libx264",
            "-crf",
            str(RATE_FACTOR),
            "-pix_fmt",
            "yuv420p",
            "-movflags",
            "+faststart",
        ]
        command = [find_ffmpeg(), "-nostdin", "-y", "-v", "error", *raw, *coded, str(path)]
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 - closed at the end of the block
        try:
            self._process = subprocess.Popen(  # noqa: S603
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=self._said,
                start_new_session=True,  # Ctrl-C is for the process that draws
            )
        except OSError as error:
            self._said.close()
            raise ViewerError(f"ffmpeg, {command[0]}, cannot be started: {error.strerror}") from error

    def add(self, picture: NDArray[np.uint8]) -> None:
        """Append a picture, shape (height, width, 3).

        Raises:
            ViewerError: ffmpeg has ended.
        """
        try:
            self._process.stdin.write(picture.tobytes())  # type: ignore[union-attr]
        except BrokenPipeError as error:
            self._process.wait()
            raise self._failure() from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            if error is not None:
                self._process.kill()
            failed = self._end() != 0
            if failed and error is None:
                raise self._failure()
        finally:
            self._said.close()

    def _end(self) -> int:
        """Return ffmpeg's exit status, once it has written what is left."""
        try:
            self._process.stdin.close()  # type: ignore[union-attr]
        except BrokenPipeError:  # it has gone before it took all
            self._process.kill()
        return self._process.wait()

    def _failure(self) -> ViewerError:
        """Return what to raise where ffmpeg has failed: the last that it said."""
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        return ViewerError(
            f"ffmpeg did not write the video: {lines[-1] if lines else 'it did not say why'}; "
            "free some space if the disk is full, and try again"
        )
