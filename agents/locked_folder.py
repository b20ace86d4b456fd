"""A folder that one process at a time works in: a training run, or a search."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import unwritable
from dq_marine.util.locks import FileLock, HeldLockError


@contextlib.contextmanager
def folder_locked(folder: Path, lock_file: str, *, doing: str) -> Iterator[None]:
    """Keep other processes from working in a folder within the block, which writes into it.

    Args:
        folder: which must exist.
        lock_file: name of the file in it that is locked.
        doing: what is done with the folder, as in "being trained".

    Raises:
        InvalidInputError: one works there already, or the folder cannot be written, at first or later.
    """
    try:
        lock = FileLock(folder / lock_file)
    except HeldLockError as error:
        raise InvalidInputError(
            f"{folder} is being {doing} by process {error.owner}; wait until it has ended, or end it"
        ) from error
    except OSError as error:
        raise unwritable(folder, error) from error
    try:
        yield
    except ConnectionError:  # a closed terminal, or a page that watches
        raise
    except OSError as error:
        raise unwritable(folder, error) from error
    finally:
        lock.release()


def holds_anything(folder: Path, lock_file: str) -> bool:
    """Whether something is in the way of a new folder, other than the lock of one that was left empty."""
    if not folder.is_dir():
        return folder.exists()
    return any(one.name != lock_file for one in folder.iterdir())
