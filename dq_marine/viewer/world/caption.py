"""Simulated time and depth, written into a picture."""

from __future__ import annotations

from typing import Any

from dq_marine.viewer.libraries import drawing_library
from dq_marine.viewer.snapshot import Snapshot

CLOCK_SHARE = 0.055
DETAIL_SHARE = 0.035
"""Heights of the two lines of text, as shares of the picture's height."""

TEXT_COLOR = (242, 251, 255)
OUTLINE_COLOR = (0, 28, 42)


def write_caption(picture: Any, snapshot: Snapshot, *, afloat: bool) -> None:
    """Write time and depth, or the height of what floats, into the top left corner of a Pillow picture."""
    draw = drawing_library("PIL.ImageDraw").Draw(picture)
    fonts = drawing_library("PIL.ImageFont")
    margin = 0.03 * picture.height
    top = margin
    depth = float(snapshot.position_ned[2])
    place = f"height {-depth:z.2f} m" if afloat else f"depth {depth:z.2f} m"
    lines = [(f"{snapshot.time:.1f} s", CLOCK_SHARE), (place, DETAIL_SHARE)]
    for text, share in lines:
        size = max(share * picture.height, 8.0)
        draw.text(
            (margin, top),
            text,
            font=fonts.load_default(size),
            fill=TEXT_COLOR,
            stroke_width=1,
            stroke_fill=OUTLINE_COLOR,
        )
        top += 1.25 * size
