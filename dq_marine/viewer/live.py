"""The vehicle in a web page, while it is simulated."""

from __future__ import annotations

import os
import sys
import webbrowser

from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.closable import Closable
from dq_marine.viewer.transport.server_process import ServerProcess
from dq_marine.viewer.world.drawing import checked_floor_depth
from dq_marine.viewer.world.stage import Stage


class LiveViewer(Closable):
    """Shows snapshots in every browser of this computer that has the viewer's page open.

    Example:
        >>> with LiveViewer(shape) as viewer:  # doctest: +SKIP
        ...     print(viewer.url)
        ...     viewer.draw(snapshot)
    """

    def __init__(self, shape: Shape, *, floor_depth: float | None = None, open_browser: bool = False) -> None:
        """Start the viewer's server.

        Args:
            shape: the vehicle.
            floor_depth: depth of the sea floor [m]; None puts one below vehicle and goal.
            open_browser: open the page in the user's browser, where there is a display.

        Raises:
            MissingDependencyError: a library of the viewer is not installed.
            InvalidInputError: `floor_depth` is not a finite number above 0.
            ViewerError: the server did not start.
        """
        floor_depth = checked_floor_depth(floor_depth)
        self._server = ServerProcess()
        self._stage = Stage(self._server, shape, floor_depth)
        if open_browser and display_present():
            webbrowser.open(self.url)

    @property
    def url(self) -> str:
        """Address of the page; only this computer can reach it."""
        return self._server.web_url

    def draw(self, snapshot: Snapshot) -> None:
        """Show a snapshot at once. How fast to call this is the caller's choice.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        self._stage.draw(snapshot)

    def clear_trail(self) -> None:
        """Begin a new episode: forget where the vehicle was.

        A snapshot whose time is earlier than that of the last one does the same by itself.
        """
        self._stage.restart()

    def close(self) -> None:
        """End the viewer's server; open pages keep the last picture. May be called again."""
        self._server.close()


def display_present() -> bool:
    """Whether a browser could open a window here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
