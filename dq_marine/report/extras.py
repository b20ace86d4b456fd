"""The libraries of the extra "report": imported where something is solved or drawn, never before."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from dq_marine.errors import MissingDependencyError

INSTALL_COMMAND = 'pip install "dq-marine[report]"'


@contextmanager
def extra_needed(purpose: str) -> Iterator[None]:
    """Wrap the imports that a module needs for its purpose.

    Raises:
        MissingDependencyError: one of them is not installed; the message says how to install it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        raise MissingDependencyError(
            f"{purpose} needs {error.name!r}, which is not installed; install it with: {INSTALL_COMMAND}"
        ) from error
