"""The optional libraries of the viewer, imported when something is drawn and not before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dq_marine.util.extras import library_folder, optional_library


def drawing_library(name: str) -> Any:
    """Import a module that only the viewer needs.

    Raises:
        MissingDependencyError: it is not installed; the message says how to install it.
    """
    return optional_library("drawing", name, "render")


def meshcat_page_folder() -> Path:
    """Return the folder with the meshcat web page, found without importing meshcat.

    Importing it would load IPython and warn about deprecated calls, in the user's own process.

    Raises:
        MissingDependencyError: meshcat is not installed.
    """
    return library_folder("drawing", "meshcat", "render") / "viewer" / "dist"
