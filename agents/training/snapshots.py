"""Snapshots of a run: folders with a model, how far the run was, and by what to tell that nothing of it is damaged."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dq_marine.checks import existing_file, finite_number, whole_number
from dq_marine.errors import InvalidInputError
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
        lesson: of the curriculum, from 0 on.
    """

    timesteps: int
    wall_time: float
    mean_return: float | None = None
    lesson: int = 0


def write_progress(folder: Path, progress: Progress) -> None:
    """Complete a snapshot whose other files are written."""
    write_json(folder / PROGRESS_FILE, vars(progress) | {DIGESTS: digests_of(folder)})


def read_progress(folder: Path) -> Progress:
    """Return how far the run was at a whole snapshot.

    Raises:
        InvalidInputError: it says what no run can have reached.
    """
    content = _content(folder)
    source = folder / PROGRESS_FILE
    mean_return = content["mean_return"]
    return Progress(
        whole_number(f"{source}: timesteps", content["timesteps"], least=0),
        finite_number(f"{source}: wall_time", content["wall_time"], least=0.0),
        None if mean_return is None else finite_number(f"{source}: mean_return", mean_return),
        whole_number(f"{source}: lesson", content.get("lesson", 0), least=0),
    )


def is_whole(folder: Path) -> bool:
    """Whether the files of a snapshot are as they were written."""
    try:
        written = _content(folder)[DIGESTS]
        return bool(read_progress(folder) and written.items() <= digests_of(folder).items())
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return False


def digests_of(folder: Path) -> dict[str, str]:
    """Return a hash of each file of a snapshot but `PROGRESS_FILE`, by name."""
    files = sorted(file for file in folder.iterdir() if file.name != PROGRESS_FILE and file.is_file())
    return {file.name: _digest(file) for file in files}


def _digest(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def _content(folder: Path) -> dict[str, Any]:
    file = existing_file("progress", folder / PROGRESS_FILE)
    if file is None:  # nothing, or a pipe, which would never end
        raise InvalidInputError(f"{folder / PROGRESS_FILE} is missing; restore it from a copy")
    content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return content
