"""Panels of even size for a panel method, from triangles of any size."""

from __future__ import annotations

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.surface import Array, area_vectors

MOST_PANELS = 5000
"""Matrices of a panel method have the square of it: 0.4 GB each in complex double precision."""

SLIVER = 1e-10
"""Panels smaller than this part of the mean are left out: they have no say, and no normal."""


def panels_of(corners: Array, wanted: int, name: str) -> Array:
    """Return triangles cut, always across their longest edge, until at least so many are left, shape (n, 3, 3).

    The surface stays the same. Edges are cut until none is longer than a length, which is made shorter until there are
    enough panels.

    Args:
        corners: of the wet surface, shape (m, 3, 3).
        wanted: number of panels.
        name: of the mesh, for messages.

    Raises:
        InvalidInputError: there would be more than `MOST_PANELS`.
    """
    areas = np.linalg.norm(area_vectors(corners), axis=1)
    corners = corners[areas > SLIVER * areas.mean()]
    # Of an equilateral triangle of area A, the edge is 1.52 sqrt(A).
    length = 3.0 * float(np.sqrt(areas.sum() / wanted))
    panels = corners
    while len(panels) < wanted:
        finer = _cut(panels, length)
        if len(finer) > MOST_PANELS:
            break
        panels, length = finer, 0.9 * length
    if len(panels) > MOST_PANELS:
        raise InvalidInputError(
            f"{name} has {len(panels):,} wet triangles, more than {MOST_PANELS:,} panels; thin it out with a mesh "
            "program (in Blender: Decimate; in MeshLab: Quadric Edge Collapse Decimation)"
        )
    return panels


def _cut(panels: Array, length: float) -> Array:
    """Return triangles without edges longer than a length, or more than `MOST_PANELS` of them."""
    while True:
        edges = np.linalg.norm(np.roll(panels, -1, axis=1) - panels, axis=2)
        long = edges.max(axis=1) > length
        if not long.any() or len(panels) > MOST_PANELS:
            return panels
        chosen, rows = panels[long], np.arange(int(long.sum()))
        start = edges[long].argmax(axis=1)
        a, b, c = (chosen[rows, (start + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        panels = np.concatenate([panels[~long], *halves])
