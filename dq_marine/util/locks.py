"""Locks between processes, which end with the process that holds them, however it ends."""

from __future__ import annotations

import contextlib
import os
from io import TextIOWrapper
from pathlib import Path

try:
    import fcntl
except ImportError:  # a system without such locks: everything counts as free
    fcntl = None  # type: ignore[assignment]


class HeldLockError(Exception):
    """Another process holds a lock.

    Attributes:
        owner: its process number, as text; empty if it is not known.
    """

    def __init__(self, owner: str) -> None:
        """Take the owner."""
        super().__init__(f"held by process {owner}")
        self.owner = owner


class FileLock:
    """An exclusive lock on a file, in which the owner's process number stands."""

    def __init__(self, path: Path) -> None:
        """Take the lock.

        Raises:
            HeldLockError: another process has it.
            OSError: the file cannot be written.
        """
        self._file: TextIOWrapper = path.open("a+", encoding="utf-8")
        try:
            if fcntl is not None:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            self._file.seek(0)
            owner = self._file.read(20).strip()
            self._file.close()
            raise HeldLockError(owner) from error
        try:
            self._file.truncate(0)
            self._file.write(str(os.getpid()))
            self._file.flush()
        except OSError:  # a full disk
            self._close()
            raise

    def release(self) -> None:
        """Let others have it."""
        self._close()

    def _close(self) -> None:
        with contextlib.suppress(OSError):  # the number that could not be written the first time
            self._file.close()


def is_free(path: Path) -> bool:
    """Whether no process holds the lock on a file that exists."""
    try:
        FileLock(path).release()
    except (HeldLockError, OSError):
        return False
    return True
