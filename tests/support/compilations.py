"""How many compilations each test file asks for, and the processor time that they take.

`pytest --compilations` prints it. With an empty folder for compiled code:

    DQ_MARINE_CACHE_DIR=$(mktemp -d) pytest --compilations tests/physics

Where two processes run the tests, each has its own watch: run one to see the table. Processes that tests start by
themselves, and do not fork, are not looked into; what they take is in the last column.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections import defaultdict
from pathlib import Path

import pytest
from numba.core.dispatcher import Dispatcher

from support.child_compilation import is_kept

RECORD = "DQ_MARINE_TESTS_COMPILATIONS"
"""Variable of the environment: a file to which a line of JSON is added for all that a test compiles or loads."""


def pytest_addoption(parser) -> None:
    """Declare `--compilations`."""
    parser.addoption("--compilations", action="store_true", help="print what was compiled, by test file")


def pytest_sessionstart(session) -> None:
    """Watch what is compiled in this process, if `--compilations` is given; children are asked from within."""
    if session.config.getoption("compilations"):
        watch = Compilations()
        watch.begin()
        session.config.pluginmanager.register(watch)


def processor_seconds() -> float:
    """Return the processor time of this process and of its children that ended."""
    return sum(os.times()[:4])


class Compilations:
    """Compilations by test file: their number, their processor time, and that of all that the file's tests do."""

    def __init__(self) -> None:
        self.number: dict[str, int] = defaultdict(int)
        self.seconds: dict[str, float] = defaultdict(float)
        self.seconds_in_all: dict[str, float] = defaultdict(float)
        self.test = ""
        self.inside = False

    @property
    def file(self) -> str:
        return self.test.split("::")[0]

    def begin(self) -> None:
        """Note every compilation of this process from now on; one within another is part of it."""
        compile_unwatched = Dispatcher.compile

        def compile_watched(dispatcher, signature):
            if self.inside or tuple(signature) in dispatcher.overloads:
                return compile_unwatched(dispatcher, signature)
            new = not is_kept(dispatcher, signature)
            self.inside, start = True, processor_seconds()
            try:
                return compile_unwatched(dispatcher, signature)
            finally:
                self.inside = False
                self.note(dispatcher, processor_seconds() - start if new else 0.0)

        Dispatcher.compile = compile_watched

    def note(self, dispatcher, seconds) -> None:
        """Count a compilation, or a function loaded from disk in no time."""
        self.number[self.file] += seconds > 0.0
        self.seconds[self.file] += seconds
        if RECORD in os.environ:
            key = getattr(dispatcher._cache, "_key", dispatcher.py_func.__qualname__)
            line = {
                "test": self.test,
                "seconds": round(seconds, 2),
                "composition": key.split("|[")[0],
                "hash": hashlib.sha256(key.encode()).hexdigest()[:8],
            }
            with Path(os.environ[RECORD]).open("a", encoding="utf-8") as record:
                record.write(json.dumps(line) + "\n")

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        self.test, start = item.nodeid, processor_seconds()
        try:
            return (yield)
        finally:
            self.seconds_in_all[self.file] += processor_seconds() - start

    def pytest_terminal_summary(self, terminalreporter) -> None:
        terminalreporter.section("compilations; their processor time and that of all [s]")
        rows = sorted(self.seconds_in_all, key=lambda file: -self.seconds[file])
        for file in rows:
            numbers = f"{self.number[file]:4} {self.seconds[file]:7.1f} {self.seconds_in_all[file]:7.1f}"
            terminalreporter.write_line(f"{numbers}  {file}")
        sums = [sum(column.values()) for column in (self.number, self.seconds, self.seconds_in_all)]
        terminalreporter.write_line("{:4} {:7.1f} {:7.1f}  in all".format(*sums))
