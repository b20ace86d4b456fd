"""Files and folders that are either complete or absent, whenever the process is killed."""

from __future__ import annotations

import csv
import errno
import io
import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from dq_marine.errors import InvalidInputError

NO_SPACE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""What systems say of a full disk, and of a user's or a process's share of it."""


def unwritable(
    path: Path, error: OSError, remedy: str = "give a folder that can be written"
) -> InvalidInputError:
    """Return what to raise where a path cannot be written.

    Args:
        path: of the file or folder.
        error: what the system said.
        remedy: unless the disk is full.
    """
    if error.errno in NO_SPACE:
        remedy = "free some space on its disk, or write to another"
    return InvalidInputError(f"{path} cannot be written: {error.strerror or error}; {remedy}")


@contextmanager
def replacing_file(path: Path) -> Iterator[Path]:
    """Yield a temporary file beside `path` that takes its place once the block has ended well.

    Raises:
        InvalidInputError: the folder does not exist, the file cannot be written, or a device or pipe is there.
    """
    temporary: Path | None = None
    try:
        if path.exists() and not (
            path.is_file() or path.is_dir()
        ):  # of a device, the name would be taken away
            raise InvalidInputError(f"{path} is a device or a pipe; give the name of a file")
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}.", suffix=path.suffix)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        temporary.chmod(0o644)  # mkstemp's files are private; what is shared by name should be readable
        os.replace(temporary, path)
    except OSError as error:
        raise unwritable(path, error, "give a file in an existing folder that can be written") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Yield a temporary folder that becomes `path`, which must not exist, once the block has ended well.

    Raises:
        InvalidInputError: the folder, or a file in it, cannot be written.
    """
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=".incomplete-"))
        yield temporary
        temporary.chmod(0o755)
        os.rename(temporary, path)
    except OSError as error:
        raise unwritable(path, error) from error
    finally:
        if temporary is not None:
            shutil.rmtree(temporary, ignore_errors=True)


def check_targets(targets: Iterable[Path], *, force: bool) -> None:
    """Check that files may be written, before anything is.

    Args:
        targets: the files.
        force: whether those that are there are to be replaced.

    Raises:
        InvalidInputError: one is a folder, or is there already.
    """
    for target in targets:
        if target.is_dir():
            raise InvalidInputError(f"{target} is a folder; give a file")
        if target.exists() and not force:
            raise InvalidInputError(f"{target} exists; choose another name, or replace it with --force")


def check_folder(path: Path) -> None:
    """Check that the folder a file is to be in exists.

    Raises:
        InvalidInputError: it does not.
    """
    if not path.parent.is_dir():
        raise InvalidInputError(f"the folder {path.parent} does not exist; create it first")


def check_ending(path: Path, ending: str) -> None:
    """Check that a file's name ends in what its kind ends in, such as ".toml".

    Raises:
        InvalidInputError: it does not.
    """
    if path.suffix != ending:
        raise InvalidInputError(f"{path} has the ending {path.suffix!r}; give a file that ends in {ending}")


def with_folder(path: Path) -> Path:
    """Return the path of a file, once the folder it is to be in exists.

    Raises:
        InvalidInputError: the folder can be neither found nor made.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(path, error) from error
    return path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file, text as UTF-8.

    Raises:
        InvalidInputError: the folder does not exist, or the file cannot be written.
    """
    with replacing_file(path) as temporary:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)


def write_json(path: Path, content: Any, *, indent: int | None = 2) -> None:
    """Write JSON. Numbers are written so that they are read back bit for bit.

    Raises:
        InvalidInputError: the folder does not exist, or the file cannot be written.
    """
    write_whole(path, json.dumps(content, indent=indent) + "\n")


def write_csv(path: Path, rows: Iterable[dict[str, Any]]) -> None:
    """Write rows as CSV, with a column for every entry that any of them has.

    Raises:
        InvalidInputError: the folder does not exist, or the file cannot be written.
    """
    listed = list(rows)
    columns = list(dict.fromkeys(name for row in listed for name in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(listed)
    write_whole(path, text.getvalue())
