"""The optional libraries of the viewer, imported when something is drawn and not before."""

from __future__ import annotations

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from dq_marine.extras import missing_library


def optional_module(name: str) -> Any:
    """Import a module that only the viewer needs.

    Raises:
        MissingDependencyError: it is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise missing_library("drawing", name, "render") from error


def meshcat_page_folder() -> Path:
    """The folder with the meshcat web page, found without importing meshcat.

    Importing it would load IPython and warn about deprecated calls, in the user's own process.

    Raises:
        MissingDependencyError: meshcat is not installed.
    """
    specification = importlib.util.find_spec("meshcat")
    if specification is None or not specification.submodule_search_locations:
        raise missing_library("drawing", "meshcat", "render")
    return Path(specification.submodule_search_locations[0]) / "viewer" / "dist"
