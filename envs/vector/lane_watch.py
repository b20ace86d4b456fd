"""A page that follows one environment of a running batch, without slowing the rest."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable

from dq_marine.viewer.live import LiveViewer
from dq_marine.viewer.snapshot import Snapshot
from dq_marine.viewer.transport.closable import Closable

FRAMES_PER_SECOND = 20.0
"""At most: each costs the interpreter about a millisecond."""


class LaneWatch(Closable):
    """Draws in a thread of its own what it is offered; what comes too often is not even looked at.

    Attributes:
        index: of the environment.
        drawn: number of pictures so far.
    """

    def __init__(
        self,
        index: int,
        open_viewer: Callable[[], LiveViewer],
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Open the viewer.

        Args:
            index: of the environment to follow.
            open_viewer: makes the viewer; called once, at once.
            clock: the time on the wall [s].
        """
        self.index = index
        self.drawn = 0
        self._clock = clock
        self._next = clock()
        self._viewer = open_viewer()
        self._waiting: queue.Queue[Snapshot | None] = queue.Queue(maxsize=1)
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._draw, name="dq-marine watch", daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._viewer.url

    def offer(self, take: Callable[[], Snapshot]) -> None:
        """Have the present state drawn, if it is time for another picture and the last one is done.

        Args:
            take: returns the present state; called only then.
        """
        now = self._clock()
        if now < self._next or self._waiting.full() or self._failure is not None:
            return
        self._next = now + 1.0 / FRAMES_PER_SECOND
        self._waiting.put_nowait(take())

    def close(self) -> None:
        """End the page's server. May be called again."""
        if self._thread.is_alive():
            self._waiting.put(None)
            self._thread.join()
        self._viewer.close()

    def _draw(self) -> None:
        while (snapshot := self._waiting.get()) is not None:
            try:
                self._viewer.draw(snapshot)
            except Exception as failure:  # a page that fails must not end the training that it shows
                self._failure = failure
                return
            self.drawn += 1
