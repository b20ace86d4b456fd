"""A drawing on its way to a server: sends the scenery once, and then what has changed."""

from __future__ import annotations

import numpy as np

from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import Shape, Snapshot
from dq_marine.viewer.transport.messages import Message, set_transform
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
        self._server.send(*self._restarted())

    def draw(self, snapshot: Snapshot) -> None:
        """Show a snapshot; one that does not continue the last one begins a new episode.

        Raises:
            ViewerError: the server has gone.
        """
        messages: list[Message] = []
        if self._last is None:
            messages += self._drawing.scenery(snapshot)
        elif _is_new_episode(self._last, snapshot):
            messages += self._restarted()
        messages += self._drawing.appear(snapshot)
        if self._last is None or snapshot.beams != self._last.beams:
            messages += draw_beams([snapshot], self._shape)
        if self._trail.extend(snapshot.position_ned, snapshot.time):
            messages.append(self._trail.message())
        moved = {
            path: placement
            for path, placement in self._drawing.placements(snapshot).items()
            if self._placed.get(path) != placement
        }
        messages += [set_transform(path, placement) for path, placement in moved.items()]
        self._server.send(*messages)
        self._placed.update(moved)
        self._last = snapshot

    def _restarted(self) -> list[Message]:
        """Forget the past, and return what takes it away from the page."""
        self._trail.restart()
        return self._drawing.restart()


def _is_new_episode(last: Snapshot, snapshot: Snapshot) -> bool:
    """Whether time went back, or the vehicle was moved while time stood still."""
    moved = not np.array_equal(last.position_ned, snapshot.position_ned)
    return snapshot.time < last.time or (snapshot.time == last.time and moved)
