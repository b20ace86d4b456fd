"""What a long measurement keeps on disk, to go on after a kill."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from suite.record import write_whole


class Checkpoint:
    """A JSON file, whose numbers come back bit for bit.

    Args:
        path: of the file.
        key: what it is good for; one that was written under another key is not there.
    """

    def __init__(self, path: Path, key: str) -> None:
        self._path = path
        self._key = key

    def read(self) -> dict[str, Any] | None:
        """Return what was written, None if there is nothing."""
        if not self._path.exists():
            return None
        kept = json.loads(self._path.read_text())
        return kept["content"] if kept["key"] == self._key else None

    def write(self, content: dict[str, Any]) -> None:
        """Replace what was written."""
        write_whole(self._path, json.dumps({"key": self._key, "content": content}))

    def remove(self) -> None:
        """Remove the file."""
        self._path.unlink(missing_ok=True)
