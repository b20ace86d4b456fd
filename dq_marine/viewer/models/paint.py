"""The colours that several models share, as three.js writes them: 0xRRGGBB."""

from __future__ import annotations

YELLOW = 0xF7BE0A
DARK = 0x2B323A
LAMP = 0xFFF6CC
SIGNAL_ORANGE = 0xFF5A0A
BOW_VIOLET = 0xC24BFF
"""Of bows, so that one sees where a vehicle is heading: the colour of no force, current, track or goal."""
