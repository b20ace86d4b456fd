"""Starboard and port."""

from __future__ import annotations

from typing import Literal

from dq_marine.errors import InvalidInputError

Side = Literal["starboard", "port"]

SIGNS: dict[str, float] = {"starboard": 1.0, "port": -1.0}
"""Sign of the helm and of the heading change towards a side."""


def sign_of(side: str) -> float:
    """Return 1 for starboard and -1 for port.

    Raises:
        InvalidInputError: it is neither.
    """
    if side not in SIGNS:
        raise InvalidInputError(f"side = {side!r} is unknown; give 'starboard' or 'port'")
    return SIGNS[side]
