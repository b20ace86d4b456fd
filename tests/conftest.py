"""How the tests run: the compiler's memory is given back; `support` says what is left out and what is measured.

Hypothesis draws the same cases in every run, so that a commit that is green stays green on another day. To look for
cases that nobody has met, let it draw anew: `pytest --hypothesis-profile searching`.
"""

from __future__ import annotations

import os
from collections import Counter

from hypothesis import settings
from support.child_compilation import compile_in_children

pytest_plugins = ("support.browser", "support.sweeps", "support.compilations")

settings.register_profile("repeatable", derandomize=True)
settings.register_profile("searching", derandomize=False, deadline=None)
settings.load_profile("repeatable")


def pytest_configure() -> None:
    """Bound the memory of long runs, and the threads of the processes that this one starts.

    Where several test side by side, BLAS's threads wait for each other: flights by MPC took five times as long.
    """
    compile_in_children()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def pytest_collection_modifyitems(items) -> None:
    """Begin with the files that take longest: a process that comes to one at the end would be alone with it."""
    slow, every = Counter(), Counter()
    for item in items:
        every[item.path] += 1
        slow[item.path] += item.get_closest_marker("slow") is not None
    items.sort(key=lambda item: (-slow[item.path], -every[item.path]))
