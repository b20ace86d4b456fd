"""Garbage is collected more rarely while something is compiled, and as before after that."""

import gc

import pytest
from numba.core import event
from support.child_compilation import HERE

from dq_marine.backend.compilation import compile_function
from dq_marine.backend.garbage import WHILE_COMPILING


def triple(x):
    return 3.0 * x


class Recorder(event.Listener):
    """Notes the thresholds with which compilations begin."""

    def __init__(self):
        self.seen = []

    def on_start(self, event):
        self.seen.append(gc.get_threshold())

    def on_end(self, event):
        pass


@pytest.fixture
def thresholds():
    before = gc.get_threshold()
    yield before
    gc.set_threshold(*before)


@pytest.mark.parametrize("own", [(700, 10, 10), (50_000, 5, 5), (0, 10, 10)], ids=["usual", "rare", "off"])
def test_thresholds_are_raised_while_compiling_only(own, thresholds, monkeypatch, tmp_path):
    monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path))  # empty, so that there is something to compile
    monkeypatch.setenv(HERE, "1")  # not in a child
    compiled = compile_function(triple, "a test")
    gc.set_threshold(*own)
    with event.install_listener("numba:compile", Recorder()) as recorder:
        assert compiled(2.0) == 6.0
    assert gc.get_threshold() == own
    assert recorder.seen == [(max(own[0], WHILE_COMPILING) if own[0] else 0, *own[1:])]
