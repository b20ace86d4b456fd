"""A lock keeps other processes out as long as its owner lives, and no longer."""

import subprocess
import sys
from pathlib import Path

import pytest

from dq_marine.util.locks import FileLock, HeldLockError, is_free

HOLD = """
import sys, time
from pathlib import Path
from dq_marine.util.locks import FileLock
lock = FileLock(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


@pytest.fixture
def holder(tmp_path: Path):
    """Another process that holds the lock."""
    command = [sys.executable, "-c", HOLD, str(tmp_path / "a.lock")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        yield process
        process.kill()


def test_the_owner_is_named_and_keeps_others_out(holder, tmp_path: Path) -> None:
    with pytest.raises(HeldLockError) as caught:
        FileLock(tmp_path / "a.lock")
    assert caught.value.owner == str(holder.pid)
    assert not is_free(tmp_path / "a.lock")


def test_a_killed_owner_holds_nothing(holder, tmp_path: Path) -> None:
    holder.kill()
    holder.wait()
    assert is_free(tmp_path / "a.lock")
    lock = FileLock(tmp_path / "a.lock")
    assert not is_free(tmp_path / "a.lock")
    lock.release()
    assert is_free(tmp_path / "a.lock")
