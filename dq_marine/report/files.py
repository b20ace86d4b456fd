"""Files that are there whole or not at all, whenever the process is killed."""

from __future__ import annotations

import csv
import io
import json
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from dq_marine.errors import InvalidInputError


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file, and its folder if it is not there.

    Raises:
        InvalidInputError: it cannot be written.
    """
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}.", suffix=path.suffix)
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        temporary.chmod(0o644)  # mkstemp's files are private
        os.replace(temporary, path)
    except OSError as error:
        raise InvalidInputError(
            f"{path} cannot be written: {error.strerror}; give a folder that can be written"
        ) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def write_json(path: Path, content: Any, *, indent: int | None = 1) -> None:
    """Write JSON. Numbers are written so that they are read back bit for bit."""
    write_whole(path, json.dumps(content, indent=indent) + "\n")


def write_csv(path: Path, rows: Iterable[dict[str, Any]]) -> None:
    """Write rows as CSV, with a column for every entry that any of them has."""
    listed = list(rows)
    columns = list(dict.fromkeys(name for row in listed for name in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(listed)
    write_whole(path, text.getvalue())
