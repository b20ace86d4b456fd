"""The files that decide what is measured, and a hash over them: what they are is read from the folders."""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Iterable
from pathlib import Path

PACKAGE = Path(__file__).parents[1]

ONLY_SHOWING = ("agents", "cli", "manoeuvres", "viewer", "report/showing")
"""Folders of the package that decide nothing about what the report measures; every other file does."""


def sources(*, without: Iterable[str]) -> list[Path]:
    """Return the package's files, sorted, without some of its folders; a checkout has two folders behind links."""
    left_out = tuple(f"{folder}/" for folder in without)
    found = [path for entry in PACKAGE.iterdir() for path in [entry, *entry.rglob("*")]]
    return sorted(
        path
        for path in found
        if path.is_file()
        and "__pycache__" not in path.parts
        and not path.relative_to(PACKAGE).as_posix().startswith(left_out)
    )


def fingerprint(files: Iterable[Path]) -> str:
    """Return a hash over files of the package: their names and what is in them."""
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.relative_to(PACKAGE).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


@functools.cache
def source_fingerprint() -> str:
    """Return a hash over the sources that decide what the report measures: not those that only show it."""
    return fingerprint(sources(without=ONLY_SHOWING))
