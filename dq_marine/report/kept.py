"""A measurement kept on disk, to go on after a kill: good only under the circumstances that it was made under."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from dq_marine.util.files import with_folder, write_json


class Kept:
    """A JSON file, whose numbers come back bit for bit.

    Args:
        path: of the file.
        stamp: what it is good for; what was written under another stamp is not there.
    """

    def __init__(self, path: Path, stamp: Any) -> None:
        self._path = path
        self._stamp = as_read(stamp)

    def read(self) -> Any:
        """Return what was written, None if there is nothing, or nothing that can be read."""
        try:
            kept = json.loads(self._path.read_text())
            return kept["content"] if kept["stamp"] == self._stamp else None
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def write(self, content: Any) -> None:
        """Replace what was written."""
        write_json(with_folder(self._path), {"stamp": self._stamp, "content": content}, indent=None)

    def remove(self) -> None:
        """Remove the file."""
        self._path.unlink(missing_ok=True)


def as_read(content: Any) -> Any:
    """Return what reading would give for what is written: lists for tuples."""
    return json.loads(json.dumps(content))
