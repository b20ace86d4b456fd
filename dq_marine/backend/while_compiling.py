"""What is otherwise while code is compiled: a step is some hundred functions, one within another, thirty deep.

Garbage is collected more rarely, which takes some 3 % less time and no more memory. Python may call as deep as
compilers within compilers do, from however deep the caller is. And only the outermost compilation is timed: Numba
starts two clocks for each, all of which hear of every call of LLVM, which takes a tenth of the time.
"""

from __future__ import annotations

import contextlib
import functools
import gc
import sys
import threading
from typing import Any

import numba
from numba.core import event

from dq_marine.backend.inlining import TRIED_VERSIONS

OBJECTS = 10_000
"""Objects more than were freed, after which Python collects garbage; its own default is 700 to 2,000."""

CALLS = 20_000
"""How deep Python may call; its own default is 1,000, and a function within another takes the compiler some 35."""


def untimed(kind: str, callback: Any) -> contextlib.AbstractContextManager[None]:
    """Stand in for `numba.core.event.install_timer`: start no clock."""
    return contextlib.nullcontext()


class _WhileCompiling(event.Listener):
    """Changes all that when the outermost of compilations within compilations begins, and back when it ends."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._depth = 0
        self._undo = contextlib.ExitStack()

    def on_start(self, event: Any) -> None:
        with self._lock:
            self._depth += 1
            if self._depth == 1:
                self._undo.enter_context(rarer_collections())
                self._undo.enter_context(deeper_calls())
                self._undo.enter_context(one_clock())

    def on_end(self, event: Any) -> None:
        with self._lock:
            self._depth -= 1
            if not self._depth:
                self._undo.close()


@contextlib.contextmanager
def rarer_collections() -> Any:
    """Raise the threshold of garbage collection, unless it is off."""
    before = gc.get_threshold()
    first, *others = before
    gc.set_threshold(max(first, OBJECTS) if first else 0, *others)
    yield
    gc.set_threshold(*before)


@contextlib.contextmanager
def deeper_calls() -> Any:
    """Raise the limit of calls within calls."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, CALLS))
    yield
    sys.setrecursionlimit(before)


@contextlib.contextmanager
def one_clock() -> Any:
    """Start no further clocks, with versions of Numba that start them as described."""
    before = event.install_timer
    if numba.version_info.short in TRIED_VERSIONS:
        event.install_timer = untimed
    yield
    event.install_timer = before


@functools.cache
def watch_compilations() -> None:
    """Do so from now on, in this process."""
    event.register("numba:compile", _WhileCompiling())
