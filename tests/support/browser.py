"""Tests marked `browser` are skipped where no browser can be run, and the last lines of pytest say how many.

With CI=true none is skipped: there a missing browser is a failure.
"""

from __future__ import annotations

import functools
import os
import subprocess

import pytest

from dq_marine.errors import MissingDependencyError
from dq_marine.viewer.transport.browser import find_chromium

REASON = "no Chromium or Chrome can be run"

REMEDY = "install one (Debian: apt-get install chromium), or let $CHROME name its executable"


@functools.cache
def present() -> bool:
    """Whether there is a browser that tells its version; Ubuntu's `chromium-browser` may be a stub that does not."""
    try:
        asked = subprocess.run([find_chromium(), "--version"], capture_output=True, timeout=60, check=False)
    except (MissingDependencyError, OSError, subprocess.TimeoutExpired):
        return False
    return asked.returncode == 0


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip what needs a browser where there is none."""
    marked = [item for item in items if item.get_closest_marker("browser")]
    if not marked or os.environ.get("CI") == "true" or present():
        return
    for item in marked:
        item.add_marker(pytest.mark.skip(reason=REASON))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how many tests were skipped for want of a browser, and how to have them run."""
    skipped = [
        one
        for one in terminalreporter.getreports("skipped")
        if isinstance(one.longrepr, tuple) and REASON in one.longrepr[2]
    ]
    if skipped:
        terminalreporter.write_line(
            f"{len(skipped)} browser tests were skipped, because {REASON}: {REMEDY}", yellow=True
        )
