"""Processes that work side by side end with the one that began them, even where it is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from dq_marine.util.side_by_side import THREAD_NUMBERS, workers

PATIENCE = 60.0
"""Longer than a busy machine takes to end a process [s]."""

SLOW = """
import time

def slowly(call):
    time.sleep(0.2)
    return call()
"""

PROGRAM = """
import os, time
from slow import slowly
from dq_marine.util.side_by_side import workers

if __name__ == "__main__":
    with workers(2) as pool:
        print(*sorted(set(pool.map(slowly, [os.getpid] * 20))), flush=True)
        time.sleep(600)
"""


def alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.fixture
def begun(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    (tmp_path / "slow.py").write_text(SLOW, encoding="utf-8")
    program = tmp_path / "program.py"
    program.write_text(PROGRAM, encoding="utf-8")
    with subprocess.Popen([sys.executable, str(program)], stdout=subprocess.PIPE, text=True) as process:
        yield process
        process.kill()


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no such signal")
def test_none_is_left_by_a_process_that_was_killed(begun: subprocess.Popen[str]) -> None:
    assert begun.stdout is not None
    numbers = [int(number) for number in begun.stdout.readline().split()]
    assert numbers
    assert all(map(alive, numbers))
    begun.kill()
    begun.wait()
    end = time.monotonic() + PATIENCE
    while any(map(alive, numbers)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(alive, numbers))


def test_what_was_not_begun_is_given_up_after_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in THREAD_NUMBERS:
        monkeypatch.delenv(name, raising=False)
    waiting = []

    def fail() -> None:
        with workers(1) as pool:
            waiting.extend(pool.submit(time.sleep, 0.2) for _ in range(100))
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert sum(one.cancelled() for one in waiting) > 90
    assert not set(THREAD_NUMBERS) & set(os.environ)
