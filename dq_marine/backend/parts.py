"""Functions that scenes share: what each is made of, so that it can be kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

PARTS: dict[Callable[..., Any], Callable[[Callable[..., Any]], tuple[str, str]]] = {}
"""Each with what returns the key and the fingerprint by which it is kept."""
