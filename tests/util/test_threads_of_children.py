"""Processes that work side by side have one thread of BLAS each, but for what the user says."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from dq_marine.util.side_by_side import THREAD_NUMBERS, one_thread_each

PROGRAM = f"import os; print([os.environ.get(name) for name in {THREAD_NUMBERS!r}])"


def told_to_a_child() -> str:
    return subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True).stdout.strip()


def test_processes_started_meanwhile_have_one_and_later_ones_what_there_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in THREAD_NUMBERS:
        monkeypatch.delenv(name, raising=False)
    before = dict(os.environ)
    with one_thread_each():
        assert told_to_a_child() == "['1', '1', '1']"
    assert dict(os.environ) == before


def test_what_the_user_said_is_left_and_nothing_stays_after_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(THREAD_NUMBERS[0], "3")
    monkeypatch.delenv(THREAD_NUMBERS[1], raising=False)
    monkeypatch.delenv(THREAD_NUMBERS[2], raising=False)
    before = dict(os.environ)
    with one_thread_each():
        assert told_to_a_child() == "['3', '1', '1']"
    assert dict(os.environ) == before
    with pytest.raises(KeyError), one_thread_each():
        raise KeyError
    assert dict(os.environ) == before
