"""Closed triangle meshes of solids with closed forms, and STL files of them; axes forward-port-up."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def box(length: float, width: float, height: float, keel: float = 0.0) -> Array:
    """A box of twelve triangles with its middle above the origin, its bottom at z = keel, shape (12, 3, 3)."""
    corners = np.array(
        [
            [x, y, z]
            for x in (-length / 2, length / 2)
            for y in (-width / 2, width / 2)
            for z in (keel, keel + height)
        ]
    )
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
    faces += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    return corners[np.array(faces)]


def ellipsoid(a: float, b: float, c: float, splits: int = 2) -> Array:
    """An ellipsoid about the origin, of an octahedron's triangles split into four so many times and projected."""
    x, y, z = np.eye(3)
    faces = [
        (p * x, q * y, r * z) if p * q * r > 0 else (q * y, p * x, r * z)
        for p in (1, -1)
        for q in (1, -1)
        for r in (1, -1)
    ]
    corners = np.array(faces)
    for _ in range(splits):
        first, second, third = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = (_unit(p + q) for p, q in ((first, second), (second, third), (third, first)))
        quarters = ((first, ab, ca), (ab, second, bc), (ca, bc, third), (ab, bc, ca))
        corners = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])
    return corners * np.array([a, b, c])


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def write_stl(path: Path, corners: Array, *, header: bytes = b"solid that is binary") -> Path:
    """Write a binary STL file."""
    records = np.zeros(len(corners), STL_RECORD)
    records["corners"] = corners
    path.write_bytes(header.ljust(80) + len(corners).to_bytes(4, "little") + records.tobytes())
    return path


def write_ascii_stl(path: Path, corners: Array) -> Path:
    """Write an ASCII STL file."""
    lines = ["solid hull"]
    for triangle in corners:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x:.17g} {y:.17g} {z:.17g}" for x, y, z in triangle]
        lines += [" endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid hull", ""]), encoding="utf-8")
    return path
