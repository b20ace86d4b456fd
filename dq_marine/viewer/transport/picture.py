"""A picture as a page sends it: "RGBA", width and height, and its pixels row by row from the bottom."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from dq_marine.viewer.libraries import drawing_library

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

HEAD = struct.Struct("<4sII")
MARK = b"RGBA"
FROM_THE_BOTTOM = -1
"""How Pillow names this order of rows."""


def is_picture(message: str | bytes) -> bool:
    """Whether what a page has sent is a whole picture."""
    if not isinstance(message, bytes) or len(message) < HEAD.size:
        return False
    mark, width, height = HEAD.unpack_from(message)
    return bool(mark == MARK and len(message) == HEAD.size + 4 * width * height)


def pixels_of(picture: bytes) -> NDArray[np.uint8]:
    """Return red, green and blue of every pixel from the top, shape (height, width, 3)."""
    import numpy as np  # here: the server knows a picture when it sees one, and needs no NumPy for that

    _, width, height = HEAD.unpack_from(picture)
    # Pillow turns rows over and drops what is no colour in less than half of the time that NumPy takes.
    return np.array(
        drawing_library("PIL.Image").frombytes(
            "RGB", (width, height), memoryview(picture)[HEAD.size :], "raw", "RGBX", 0, FROM_THE_BOTTOM
        )
    )
