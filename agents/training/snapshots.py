"""Snapshots of a run: folders with a model, how far the run was, and by what to tell that nothing of it is damaged."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dq_marine.util.files import write_json

PROGRESS_FILE = "progress.json"
DIGESTS = "sha256"
"""Entry of `PROGRESS_FILE`: a hash of each other file, by name."""


@dataclass(frozen=True)
class Progress:
    """How far a run was at a snapshot.

    Attributes:
        timesteps: learned from.
        wall_time: spent [s], over all sessions.
        mean_return: of the evaluation that made this the best so far; None if there was none.
    """

    timesteps: int
    wall_time: float
    mean_return: float | None = None


def write_progress(folder: Path, progress: Progress) -> None:
    """Complete a snapshot whose other files are written."""
    write_json(folder / PROGRESS_FILE, vars(progress) | {DIGESTS: digests_of(folder)})


def read_progress(folder: Path) -> Progress:
    """Return how far the run was at a whole snapshot."""
    content = _content(folder)
    return Progress(**{name: value for name, value in content.items() if name != DIGESTS})


def is_whole(folder: Path) -> bool:
    """Whether the files of a snapshot are as they were written."""
    try:
        content = _content(folder)
        return bool(digests_of(folder) == content[DIGESTS] and read_progress(folder))
    except (OSError, ValueError, KeyError, TypeError):
        return False


def digests_of(folder: Path) -> dict[str, str]:
    """Return a hash of each file of a snapshot but `PROGRESS_FILE`, by name."""
    files = sorted(file for file in folder.iterdir() if file.name != PROGRESS_FILE)
    return {file.name: _digest(file) for file in files}


def _digest(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def _content(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / PROGRESS_FILE).read_text(encoding="utf-8"))
    return content
