"""Functions that scenes share, so that what is compiled of them is kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

PARTS: set[Callable[..., Any]] = set()
"""Filled as scenes are compiled."""
