"""A picture as a page sends it: "RGBA", width and height, and its pixels row by row from the bottom."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

HEAD = struct.Struct("<4sII")
MARK = b"RGBA"


def is_picture(message: str | bytes) -> bool:
    """Whether what a page has sent is a whole picture."""
    if not isinstance(message, bytes) or len(message) < HEAD.size:
        return False
    mark, width, height = HEAD.unpack_from(message)
    return bool(mark == MARK and len(message) == HEAD.size + 4 * width * height)


def pixels_of(picture: bytes) -> NDArray[np.uint8]:
    """Return red, green and blue of every pixel from the top, shape (height, width, 3)."""
    _, width, height = HEAD.unpack_from(picture)
    rows = np.frombuffer(picture, np.uint8, offset=HEAD.size).reshape(height, width, 4)
    return np.ascontiguousarray(rows[::-1, :, :3])
