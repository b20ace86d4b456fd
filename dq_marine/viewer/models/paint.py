"""The colours that several models share, as three.js writes them: 0xRRGGBB."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from dq_marine.viewer.snapshot import FloatArray
from dq_marine.viewer.transport.three_json import Painted, rgb

YELLOW = 0xF7BE0A
DARK = 0x2B323A
LAMP = 0xFFF6CC
SIGNAL_ORANGE = 0xFF5A0A
BOW_VIOLET = 0xC24BFF
"""Of bows, so that one sees where a vehicle is heading: the colour of no force, current, track or goal."""

FLIGHT_COLORS = (0xFFC928, 0xFF5C9E, 0xF4F7FA, 0x2B4BD8, 0xFF7A1A, 0x8A5A2B)
"""Of flights that are shown in one scene, in their order, told apart from one another and from water: yellow, pink,
white, blue, orange, brown."""

TINT = 0.75
"""Share of a flight's colour in that of its vehicle, which keeps light and dark parts."""


def tinted(parts: Iterable[Painted], tint: int | None) -> list[Painted]:
    """Return painted meshes in shades of a tint, 0xRRGGBB, but for bows; None leaves them as they are."""
    if tint is None:
        return list(parts)
    return [one if one.color == BOW_VIOLET else replace(one, color=_mixed(one.color, tint)) for one in parts]


def tinted_colors(colors: FloatArray, tint: int | None) -> FloatArray:
    """Return colours, shape (n, 3), in shades of a tint, 0xRRGGBB; None leaves them as they are."""
    return colors if tint is None else (1.0 - TINT) * colors + TINT * rgb(tint)


def _mixed(color: int, tint: int) -> int:
    """Return the colour that has the share `TINT` of another one."""
    shares = ((color >> shift & 0xFF, tint >> shift & 0xFF, shift) for shift in (16, 8, 0))
    return sum(round((1.0 - TINT) * own + TINT * other) << shift for own, other, shift in shares)
