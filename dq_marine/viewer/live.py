"""The vehicle in a web page, while it is simulated."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from dq_marine.viewer.controls import Event, Group, Panel
from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.closable import Closable
from dq_marine.viewer.transport.messages import delete, show_panel
from dq_marine.viewer.transport.server_process import ServerProcess
from dq_marine.viewer.world.drawing import WORLD, checked_floor_depth
from dq_marine.viewer.world.stage import Stage


class Reading(NamedTuple):
    """A number to read: what it is, how much, and its unit ("" for a pure number)."""

    label: str
    value: float
    unit: str = ""


class LiveViewer(Closable):
    """Shows snapshots in every browser of this computer that has the viewer's page open.

    Example:
        >>> with LiveViewer(shape) as viewer:  # doctest: +SKIP
        ...     print(viewer.url)
        ...     viewer.draw(snapshot)
    """

    def __init__(
        self,
        shape: Shape,
        *,
        title: str = "",
        floor_depth: float | None = None,
        open_browser: bool = False,
    ) -> None:
        """Start the viewer's server.

        Args:
            shape: the vehicle.
            title: above the scene.
            floor_depth: depth of the sea floor [m]; None puts one below vehicle and goal.
            open_browser: open the page in the user's browser, where there is a display.

        Raises:
            MissingDependencyError: a library of the viewer is not installed.
            InvalidInputError: `floor_depth` is not a finite number above 0.
            ViewerError: the server did not start.
        """
        self._floor_depth = checked_floor_depth(floor_depth)
        self._server = ServerProcess()
        self._stage = Stage(self._server, shape, self._floor_depth)
        self._panel = Panel(())
        if title:
            self._server.send(show_panel("title", {"text": title}))
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

    def show_vehicle(self, shape: Shape, title: str) -> None:
        """Draw another vehicle from now on, and its surroundings anew; the panel stays.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        self._server.send(delete(WORLD))
        self._stage = Stage(self._server, shape, self._floor_depth)
        self._server.send(show_panel("title", {"text": title}))

    def show_controls(self, groups: Sequence[Group]) -> None:
        """Put controls on the pages' panels, in place of those that were there; `events` tells what is done with them.

        Raises:
            InvalidInputError: two controls have one name.
            ViewerError: the viewer is closed, or its server has gone.
        """
        self._panel = Panel(groups)
        self._server.send(show_panel("controls", {"groups": self._panel.described()}))

    def show_values(self, values: Mapping[str, Any]) -> None:
        """Let controls show values, by name, that were not chosen in a page.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        self._server.send(show_panel("values", {"values": dict(values)}))

    def show_readings(self, time: float, groups: Mapping[str, Sequence[Reading]]) -> None:
        """Show numbers, each with its recent history.

        Args:
            time: simulated [s].
            groups: readings by the heading that they stand under.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        rows = {label: [list(reading) for reading in readings] for label, readings in groups.items()}
        self._server.send(show_panel("readings", {"time": time, "groups": rows}))

    def show_notice(self, text: str) -> None:
        """Show a line below the clock; "" takes it away.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        self._server.send(show_panel("notice", {"text": text}))

    def events(self) -> list[Event]:
        """What was done with the controls since the last call, in any page, oldest first.

        Raises:
            ViewerError: the viewer is closed, or its server has gone.
        """
        return self._panel.read(self._server.take_words())

    def clear_trail(self) -> None:
        """Begin a new episode: forget where the vehicle was.

        A snapshot whose time is earlier than that of the last one does the same by itself.
        """
        self._stage.restart()
        self._server.send(show_panel("episode", {}))

    def close(self) -> None:
        """End the viewer's server; open pages keep the last picture. May be called again."""
        self._server.close()


def display_present() -> bool:
    """Whether a browser could open a window here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
