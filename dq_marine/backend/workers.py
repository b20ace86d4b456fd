"""Compiled work over a range of blocks, shared out among threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

import numpy as np
from numba.core.errors import NumbaError

from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError

MOST_THREADS = 1024

BLOCKS_WORTH_A_THREAD = 64
"""Waking a thread takes some 50 us, in which one computes about as many blocks."""


def usable_cores() -> int:
    """Return how many cores this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def checked_threads(threads: int | None, blocks: int) -> int:
    """Return a number of threads for some blocks; None means as many as pay.

    Raises:
        InvalidInputError: it is not a whole number from 1 to `MOST_THREADS`.
    """
    if threads is None:
        return max(1, min(usable_cores(), blocks // BLOCKS_WORTH_A_THREAD))
    if (
        isinstance(threads, bool)
        or not isinstance(threads, int | np.integer)
        or not 1 <= threads <= MOST_THREADS
    ):
        raise InvalidInputError(
            f"threads = {shown(threads)}; give None or a whole number from 1 to {MOST_THREADS}"
        )
    return min(int(threads), blocks)


class Workers:
    """Runs compiled functions over blocks, which do not depend on each other, in a fixed number of threads.

    The calling thread does a share of its own. Compiled functions release the interpreter's lock while they run.
    """

    def __init__(self, threads: int | None, blocks: int) -> None:
        self.threads = checked_threads(threads, blocks)
        edges = [blocks * part // self.threads for part in range(self.threads + 1)]
        *self._others, self._own = pairwise(edges)
        self._pool: ThreadPoolExecutor | None = None
        self._process = os.getpid()

    def run(self, function: Callable[..., Any], *arguments: Any) -> None:
        """Call function(first, last, *arguments) for every thread's share of the blocks, and wait for all.

        Raises:
            InvalidInputError: a force cannot be compiled for lanes.
        """
        try:
            self._run(function, *arguments)
        except NumbaError as error:
            raise InvalidInputError(
                "the step cannot be compiled for many bodies at once. A force of your own that asks `if`, `and`, `or`, "
                "`not`, `min` or `max` of a number needs ForceTerm(..., branches=True), or the functions of "
                f"dq_marine.algebra.selection instead. Numba's words: {error}"
            ) from error

    def _run(self, function: Callable[..., Any], *arguments: Any) -> None:
        submit = self._executor().submit if self._others else None
        waiting = [submit(function, *share, *arguments) for share in self._others] if submit else ()
        try:
            function(*self._own, *arguments)
        finally:
            for future in waiting:
                future.result()

    def close(self) -> None:
        """End the threads; they start again when there is work."""
        if self._pool is not None and self._process == os.getpid():
            self._pool.shutdown()
        self._pool = None

    def _executor(self) -> ThreadPoolExecutor:
        if self._pool is None or self._process != os.getpid():  # threads do not survive a fork
            self._pool = ThreadPoolExecutor(self.threads - 1, thread_name_prefix="dq-marine")
            self._process = os.getpid()
        return self._pool
