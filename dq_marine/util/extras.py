"""The libraries of the extras: imported where they are needed, never before."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from dq_marine.errors import MissingDependencyError


def missing_library(purpose: str, library: str | None, extra: str) -> MissingDependencyError:
    """Return the error that says which library a purpose needs, and the command that installs its extra."""
    return MissingDependencyError(
        f"{purpose} needs {library!r}, which is not installed; install it with: "
        f'pip install "dq-marine[{extra}]"'
    )


@contextmanager
def extra_needed(purpose: str, extra: str) -> Iterator[None]:
    """Wrap the imports that a module needs for its purpose.

    Raises:
        MissingDependencyError: one of them is not installed; the message says how to install the extra.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        raise missing_library(purpose, error.name, extra) from error


def optional_library(purpose: str, name: str, extra: str) -> Any:
    """Import a library when a purpose needs it.

    Raises:
        MissingDependencyError: it is not installed; the message says how to install the extra.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise missing_library(purpose, name, extra) from error


def library_folder(purpose: str, name: str, extra: str) -> Path:
    """Return the folder of a library, found without importing it.

    Raises:
        MissingDependencyError: it is not installed; the message says how to install the extra.
    """
    specification = importlib.util.find_spec(name)
    if specification is None or not specification.submodule_search_locations:
        raise missing_library(purpose, name, extra)
    return Path(specification.submodule_search_locations[0])
