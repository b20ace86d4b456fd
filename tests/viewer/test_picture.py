"""A picture comes from a page as it is in memory there, and is turned the right way up."""

from __future__ import annotations

import numpy as np
import pytest

from dq_marine.viewer.transport.picture import HEAD, MARK, is_picture, pixels_of

ROWS = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4)
"""Two rows of three pixels, from the bottom."""

PICTURE = HEAD.pack(MARK, 3, 2) + ROWS.tobytes()


def test_the_first_row_is_the_upper_one_and_opacity_is_left_out() -> None:
    pixels = pixels_of(PICTURE)
    assert pixels.shape == (2, 3, 3)
    assert pixels.tolist() == ROWS[::-1, :, :3].tolist()
    assert pixels.flags.writeable


@pytest.mark.parametrize(
    "message",
    [
        "RGBA",
        b"",
        b"RGBA",
        PICTURE[:-1],
        PICTURE + b"\x00",
        b"RGB " + PICTURE[4:],
        HEAD.pack(MARK, 2**31, 2**31),
    ],
    ids=["text", "nothing", "mark", "too short", "too long", "another mark", "no pixels"],
)
def test_what_is_no_whole_picture_is_told(message: str | bytes) -> None:
    assert is_picture(PICTURE)
    assert not is_picture(message)
