"""A drawing on its way to a server: sends the scenery once, and then what has changed."""

from __future__ import annotations

import numpy as np

from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.messages import set_transform
from dq_marine.viewer.transport.server_process import ServerProcess
from dq_marine.viewer.world.beams import draw_beams
from dq_marine.viewer.world.drawing import Drawing
from dq_marine.viewer.world.trail import Trail

TRAIL_SPACING_IN_LENGTHS = 0.05


class Stage:
    """Draws snapshot after snapshot, of one episode after the other."""

    def __init__(self, server: ServerProcess, shape: Shape, floor_depth: float | None) -> None:
        """Draw nothing yet.

        Args:
            server: carries the messages to the pages.
            shape: the vehicle.
            floor_depth: depth of the sea floor [m], or None for one below vehicle and goal.
        """
        self._server, self._shape = server, shape
        self._drawing = Drawing(shape, floor_depth)
        self._trail = Trail(TRAIL_SPACING_IN_LENGTHS * shape.length)
        self._placed: dict[str, Placement] = {}
        self._last: Snapshot | None = None

    def restart(self) -> None:
        """Forget the past: the next snapshot begins a new episode."""
        for message in self._drawing.restart():
            self._server.send(message)
        self._trail.restart()

    def draw(self, snapshot: Snapshot) -> None:
        """Show a snapshot; one that does not continue the last one begins a new episode.

        Raises:
            ViewerError: the server has gone.
        """
        if self._last is None:
            for message in self._drawing.scenery(snapshot):
                self._server.send(message)
        elif _is_new_episode(self._last, snapshot):
            self.restart()
        for message in self._drawing.appear(snapshot):
            self._server.send(message)
        if self._last is None or snapshot.beams != self._last.beams:
            for message in draw_beams([snapshot], self._shape):
                self._server.send(message)
        if self._trail.extend(snapshot.position_ned, snapshot.time):
            self._server.send(self._trail.message())
        for path, placement in self._drawing.placements(snapshot).items():
            if self._placed.get(path) != placement:
                self._server.send(set_transform(path, placement))
                self._placed[path] = placement
        self._last = snapshot


def _is_new_episode(last: Snapshot, snapshot: Snapshot) -> bool:
    """Whether time went back, or the vehicle was moved while time stood still."""
    moved = not np.array_equal(last.position_ned, snapshot.position_ned)
    return snapshot.time < last.time or (snapshot.time == last.time and moved)
