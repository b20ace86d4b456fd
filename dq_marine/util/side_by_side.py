"""Processes that work side by side: one thread of BLAS in each, as there are processors for no more.

BLAS's threads wait for each other in loops, which is in vain while other processes have the processors.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

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
