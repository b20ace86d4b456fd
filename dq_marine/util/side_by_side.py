"""Processes that work side by side: one thread of BLAS in each, as there are processors for no more.

BLAS's threads wait for each other in loops, which is in vain while other processes have the processors.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import AbstractContextManager
from typing import Any, Protocol

THREAD_NUMBERS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")
"""Variables of the environment that BLAS, by whomever it was made, reads when it is loaded."""


@contextlib.contextmanager
def one_thread_each() -> Iterator[None]:
    """Let processes that are started meanwhile have one thread each, unless the user has said how many."""
    unset = [name for name in THREAD_NUMBERS if name not in os.environ]
    os.environ.update(dict.fromkeys(unset, "1"))
    try:
        yield
    finally:
        for name in unset:
            os.environ.pop(name, None)


class Pool(Protocol):
    """Takes tasks, each to be called by one of several workers: an executor, or a cluster's."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Future[Any]:
        """Let function(*arguments) be called, and return what will be its result."""
        ...


Team = Callable[[int], AbstractContextManager[Pool]]
"""(how many tasks there will be, one or more) -> the pool that works on them within a block."""


def team_here(processes: int) -> Team:
    """Return the team of so many processes of this machine, or of one for each task where these are fewer."""
    return lambda tasks: workers(min(processes, tasks))


@contextlib.contextmanager
def workers(count: int) -> Iterator[ProcessPoolExecutor]:
    """Let so many processes work within the block, which import what they need anew.

    They end with the block, by an exception after what they are at; and with this process, even where it is killed.
    """
    context = multiprocessing.get_context("spawn")
    with one_thread_each(), ProcessPoolExecutor(count, context, _end_with_parent) as pool:
        try:
            yield pool
        except BaseException:
            # This waits, or the end of the block would take back that what waits is given up.
            pool.shutdown(cancel_futures=True)
            raise


def _end_with_parent() -> None:
    """Watch the process that began this one: who is killed cannot say so, and this one would wait for ever."""
    threading.Thread(target=_leave_after_parent, daemon=True).start()


def _leave_after_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
