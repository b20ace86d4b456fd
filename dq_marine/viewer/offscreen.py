"""Pictures of the vehicle as arrays of pixels, without any display."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.errors import ViewerError
from dq_marine.viewer.libraries import drawing_library
from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.browser import HeadlessBrowser, find_chromium
from dq_marine.viewer.transport.closable import Closable
from dq_marine.viewer.transport.messages import set_property
from dq_marine.viewer.transport.server_process import ServerProcess
from dq_marine.viewer.world.camera import CAMERA
from dq_marine.viewer.world.caption import write_caption
from dq_marine.viewer.world.drawing import checked_floor_depth
from dq_marine.viewer.world.stage import Stage

FIRST_PICTURE_TIMEOUT = 60.0
PICTURE_TIMEOUT = 20.0
"""Seconds; the first picture includes the start of the browser."""

LARGEST_SIDE = 8192
"""Pixels; WebGL promises no more."""


class OffscreenViewer(Closable):
    """Draws snapshots in a browser without a window and returns what it shows."""

    def __init__(
        self,
        shape: Shape,
        width: int = 640,
        height: int = 480,
        *,
        floor_depth: float | None = None,
        caption: bool = True,
        smooth: bool = False,
    ) -> None:
        """Start the viewer's server and a Chromium.

        Args:
            shape: the vehicle.
            width: of the pictures [pixels].
            height: of the pictures [pixels].
            floor_depth: depth of the sea floor [m]; None puts one below vehicle and goal.
            caption: write simulated time and depth in a corner of the picture.
            smooth: smooth the edges of things, which takes 1.6 times as long: for videos and pictures to look at.

        Raises:
            MissingDependencyError: a library of the viewer, or Chromium, is not installed.
            InvalidInputError: a size that cannot be drawn, or a `floor_depth` not above 0.
            ViewerError: the server did not start.
        """
        for name, pixels in (("width", width), ("height", height)):
            if not 1 <= pixels <= LARGEST_SIDE:
                raise InvalidInputError(f"{name} is {pixels}; give 1 to {LARGEST_SIDE} pixels")
        floor_depth = checked_floor_depth(floor_depth)
        self._image = drawing_library("PIL.Image")
        find_chromium()
        self._size, self._smooth = (width, height), smooth
        self._caption, self._afloat = caption, shape.floats
        self._timeout = FIRST_PICTURE_TIMEOUT
        try:
            self._server = ServerProcess(self._open_browser)
        except ViewerError:
            self._browser.close()
            raise
        self._stage = Stage(self._server, shape, floor_depth)

    def render(self, snapshot: Snapshot) -> NDArray[np.uint8]:
        """A picture of a snapshot.

        Returns:
            Red, green and blue of every pixel, shape (height, width, 3).

        Raises:
            ViewerError: the viewer is closed, or its server or browser has gone.
        """
        self._stage.draw(snapshot)
        pixels = self._server.capture(self._timeout, self._check_browser)
        self._timeout = PICTURE_TIMEOUT
        size = pixels.shape[1::-1]
        if size != self._size:
            raise ViewerError(f"the browser drew {size} pixels instead of {self._size}")
        if self._caption:
            picture = self._image.fromarray(pixels)
            write_caption(picture, snapshot, afloat=self._afloat)
            pixels = np.array(picture)
        return pixels

    def look_from(self, offset_ned: Sequence[float]) -> None:
        """Put the camera elsewhere, for all pictures after the first; it looks at the vehicle.

        Args:
            offset_ned: of the camera from the vehicle [m], shape (3,).

        Raises:
            InvalidInputError: it is not three finite numbers, or of no length.
            ViewerError: the viewer is closed.
        """
        north, east, down = finite_array("offset_ned", offset_ned, 3).tolist()
        if not (north or east or down):
            raise InvalidInputError("offset_ned = [0, 0, 0] is where the vehicle is; give a place beside it")
        self._server.send(set_property(f"{CAMERA}/<object>", "position", [north, -down, east]))

    def clear_trail(self) -> None:
        """Begin a new episode: forget where the vehicle was.

        A snapshot whose time is earlier than that of the last one does the same by itself.
        """
        self._stage.restart()

    def close(self) -> None:
        """End server and browser. May be called again."""
        self._browser.close()
        self._server.close()

    def _open_browser(self, web_url: str) -> None:
        width, height = self._size
        address = f"{web_url}capture?width={width}&height={height}&smooth={self._smooth:d}"
        self._browser = HeadlessBrowser(address, width, height)

    def _check_browser(self) -> None:
        if not self._browser.running:
            self.close()
            raise ViewerError("the headless Chromium has ended; open a new viewer")
