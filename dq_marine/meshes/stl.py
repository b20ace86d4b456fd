"""Reading triangles from an STL file, binary or ASCII (3D Systems 1988, StereoLithography Interface Specification)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError

HEADER_BYTES = 84  # 80 of text, 4 with the number of triangles
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)\s*$", re.MULTILINE | re.IGNORECASE)


def read_stl(file: Path) -> NDArray[np.float64]:
    """Return the corners of an STL file's triangles, in the file's own unit and axes, shape (n, 3, 3).

    The normals in the file are ignored: the order of the corners tells the outside.

    Raises:
        InvalidInputError: there is no such file, it is too large, cannot be read, is no STL file, was cut short, or
            has a coordinate that is no finite number.
    """
    path = existing_file("mesh", file)
    if path is None:
        raise InvalidInputError(f"there is no mesh {shown(str(file))}; give the path of an STL file")
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InvalidInputError(
            f"{path} cannot be read: {error.strerror}; give a file that can be"
        ) from error
    corners = _binary(content)
    if corners is None:
        corners = _ascii(content, path)
    wrong = np.flatnonzero(~np.isfinite(corners).all(axis=(1, 2)))
    if wrong.size:
        raise InvalidInputError(
            f"{path}: triangle {wrong[0] + 1} of {len(corners)} has a coordinate that is not finite; export it again"
        )
    return corners


def _binary(content: bytes) -> NDArray[np.float64] | None:
    """Return the triangles of a binary file; None if the size is not that which the count in it asks for.

    The first word is no test: many programs begin binary files with "solid", too.
    """
    if len(content) < HEADER_BYTES:
        return None
    count = int.from_bytes(content[HEADER_BYTES - 4 : HEADER_BYTES], "little")
    if count == 0 or len(content) != HEADER_BYTES + count * RECORD.itemsize:
        return None
    return np.asarray(np.frombuffer(content, RECORD, count, HEADER_BYTES)["corners"], dtype=np.float64)


def _ascii(content: bytes, path: Path) -> NDArray[np.float64]:
    """Return the triangles of an ASCII file."""
    ends = content.rstrip().lower().rsplit(b"\n", 1)[-1].lstrip().startswith(b"endsolid")
    if not content.lstrip()[:5].lower() == b"solid" or not ends:
        raise InvalidInputError(
            f"{path}: {len(content):,} bytes that are neither a whole binary nor a whole ASCII STL file; export "
            "the mesh as STL again"
        )
    try:
        numbers = np.array(
            [[float(number) for number in found] for found in VERTEX.findall(content)], dtype=np.float64
        )
    except ValueError as error:
        raise InvalidInputError(f"{path}: {error}; export the mesh as STL again") from error
    facets = len(re.findall(rb"^\s*facet\b", content, re.MULTILINE | re.IGNORECASE))
    if facets == 0 or len(numbers) != 3 * facets:
        raise InvalidInputError(
            f"{path}: {facets} facets with {len(numbers)} vertices; each has three: export the mesh as STL again"
        )
    return numbers.reshape(facets, 3, 3)
