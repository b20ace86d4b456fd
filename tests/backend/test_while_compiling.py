"""Garbage, calls and clocks are otherwise while something is compiled, and as before after that."""

import gc
import sys

import numba
import pytest
from numba.core import event
from support.child_compilation import HERE

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.inlining import TRIED_VERSIONS
from dq_marine.backend.while_compiling import CALLS, OBJECTS


def triple(x):
    return 3.0 * x


def sum_of(count):
    """A function that calls another, and so on, so many deep; its value is x + count."""
    if count == 0:
        return lambda x: 1.0 * x
    rest = sum_of(count - 1)

    def one_more(x):
        return rest(x) + 1.0

    return one_more


class Recorder(event.Listener):
    """Notes what holds when compilations begin."""

    def __init__(self):
        self.seen, self.calls, self.clocks = [], [], []

    def on_start(self, begun):
        self.seen.append(gc.get_threshold())
        self.calls.append(sys.getrecursionlimit())
        self.clocks.append(event.install_timer)

    def on_end(self, event):
        pass


@pytest.fixture
def thresholds():
    before = gc.get_threshold()
    yield before
    gc.set_threshold(*before)


@pytest.fixture
def compiled_here(monkeypatch, tmp_path):
    """An empty cache, so that there is something to compile, and no child to do it."""
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv(HERE, "1")


@pytest.mark.parametrize("own", [(700, 10, 10), (50_000, 5, 5), (0, 10, 10)], ids=["usual", "rare", "off"])
def test_thresholds_are_raised_while_compiling_only(own, thresholds, compiled_here):
    compiled = compile_function(triple, "a test")
    gc.set_threshold(*own)
    with event.install_listener("numba:compile", Recorder()) as recorder:
        assert compiled(2.0) == 6.0
    assert gc.get_threshold() == own
    assert recorder.seen == [(max(own[0], OBJECTS) if own[0] else 0, *own[1:])]


def test_functions_forty_deep_compile_from_deep_within_a_program(compiled_here):
    """As those of a task do: a compilation within another takes some 35 calls of the thousand that Python allows."""

    def from_within(calls):
        return from_within(calls - 1) if calls else compile_function(sum_of(40), "a test")(0.5)

    limit = sys.getrecursionlimit()
    assert from_within(500) == 40.5
    assert sys.getrecursionlimit() == limit < CALLS


def test_only_the_outermost_compilation_is_timed(compiled_here):
    clock = event.install_timer
    with event.install_listener("numba:compile", Recorder()) as recorder:
        assert compile_function(sum_of(2), "a test")(0.5) == 2.5
    assert event.install_timer is clock
    assert len(recorder.clocks) == 3
    assert all(
        (used is clock) == (numba.version_info.short not in TRIED_VERSIONS) for used in recorder.clocks
    )


def test_a_compilation_that_fails_leaves_all_as_it_was(compiled_here):
    before = gc.get_threshold(), sys.getrecursionlimit(), event.install_timer
    with pytest.raises(numba.TypingError):
        compile_function(triple, "a test")("no number")
    assert (gc.get_threshold(), sys.getrecursionlimit(), event.install_timer) == before
