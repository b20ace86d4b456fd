"""From a heap of triangles to closed surfaces with their outside out, or a refusal that says what to mend."""

from __future__ import annotations

from collections import deque

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.surface import Array, Integers, Surface, enclosed

MOST_TRIANGLES = 20_000
"""More would say nothing about added mass, and take hours."""

MERGED = 1e-6
"""Corners nearer than this part of the mesh's size are one."""

FLAT = 1e-9
"""A volume below this part of its box's is none."""


def closed_surface(corners: Array, name: str) -> tuple[Surface, int]:
    """Return triangles as a surface that is closed and has its outside out, and how many had to be turned for it.

    Args:
        corners: shape (n, 3, 3).
        name: of the mesh, for messages.

    Raises:
        InvalidInputError: there are too many triangles; they do not close; edges belong to more than two; inside and
            outside cannot be told; nothing is enclosed; or one part lies within or across another.
    """
    if len(corners) > MOST_TRIANGLES:
        raise InvalidInputError(
            f"{name} has {len(corners):,} triangles, more than {MOST_TRIANGLES:,}; thin it out with a mesh program "
            "(in Blender: Decimate; in MeshLab: Quadric Edge Collapse Decimation)"
        )
    surface = _merged(corners)
    neighbours = _neighbours(surface, name)
    parts, turned = _oriented(surface.triangles, neighbours, name)
    triangles = np.where(turned[:, None], surface.triangles[:, ::-1], surface.triangles)
    count = 0
    for part in range(parts.max() + 1):
        own = parts == part
        volume = enclosed(surface.vertices[triangles[own]]).volume
        box = float(np.prod(np.ptp(surface.vertices[triangles[own]].reshape(-1, 3), axis=0)))
        if abs(volume) <= FLAT * box or volume == 0.0:
            raise InvalidInputError(
                f"{name}: a part of {own.sum()} triangles encloses nothing; give a hull with a thickness"
            )
        if volume < 0.0:
            triangles[own] = triangles[own][:, ::-1]
            turned[own] = ~turned[own]
        count += int(turned[own].sum())
    _check_parts_apart(surface.vertices[triangles], parts, name)
    return Surface(surface.vertices, triangles), count


def _merged(corners: Array) -> Surface:
    """Return triangles that share their corners, without those that have no area."""
    points = corners.reshape(-1, 3)
    size = float(np.ptp(points, axis=0).max()) or 1.0
    _, first, number = np.unique(
        np.round(points / (MERGED * size)), axis=0, return_index=True, return_inverse=True
    )
    triangles = number.reshape(-1, 3).astype(np.int64)
    a, b, c = triangles.T
    return Surface(points[first], triangles[(a != b) & (b != c) & (c != a)])


def _neighbours(surface: Surface, name: str) -> Integers:
    """Return for each triangle its neighbour across each side, shape (m, 3)."""
    triangles = surface.triangles
    if len(triangles) == 0:
        raise InvalidInputError(f"{name} has no triangle with an area; export the mesh again")
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, number, counts = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    if (counts != 2).any():
        wrong = int(np.flatnonzero(counts != 2)[0])
        place = ", ".join(f"{value:.4g}" for value in surface.vertices[edges[wrong]].mean(axis=0))
        open_edges, shared = int((counts == 1).sum()), int((counts > 2).sum())
        raise InvalidInputError(
            f"{name} is not closed: {open_edges} edges have a triangle on one side only, and {shared} have more than "
            f"two; one is at ({place}) in the file's axes: fill the holes, the deck too, and leave out inner walls"
        )
    order = np.argsort(number.ravel(), kind="stable").reshape(-1, 2)
    across = np.empty(len(sides), dtype=np.int64)
    across[order[:, 0]], across[order[:, 1]] = order[:, 1], order[:, 0]
    return np.asarray(across // 3).reshape(-1, 3)


def _oriented(triangles: Integers, neighbours: Integers, name: str) -> tuple[Integers, np.ndarray]:
    """Return the part that each triangle belongs to, and whether it must be turned to agree with its part's first."""
    parts = np.full(len(triangles), -1, dtype=np.int64)
    turned = np.zeros(len(triangles), dtype=bool)
    directed = [{(t[0], t[1]), (t[1], t[2]), (t[2], t[0])} for t in triangles.tolist()]
    part = -1
    for start in range(len(triangles)):
        if parts[start] >= 0:
            continue
        part += 1
        parts[start] = part
        queue = deque([start])
        while queue:
            here = queue.popleft()
            for there in neighbours[here].tolist():
                # Two neighbours agree if they run along their common edge in opposite directions.
                wanted = bool(turned[here]) ^ bool(directed[here] & directed[there])
                if parts[there] < 0:
                    parts[there], turned[there] = part, wanted
                    queue.append(there)
                elif turned[there] != wanted:
                    raise InvalidInputError(
                        f"{name} has no outside: its triangles cannot all be turned to agree; remodel it as a solid"
                    )
    return parts, turned


def _check_parts_apart(corners: Array, parts: Integers, name: str) -> None:
    """Check that no part has a corner within another: volumes would count twice, and inner walls as hull."""
    count = int(parts.max()) + 1
    boxes = [corners[parts == part].reshape(-1, 3) for part in range(count)]
    lows, highs = ([operation(box, axis=0) for box in boxes] for operation in (np.min, np.max))
    for inner in range(count):
        for outer in range(count):
            if inner == outer or (lows[inner] > highs[outer]).any() or (lows[outer] > highs[inner]).any():
                continue
            points = np.unique(boxes[inner], axis=0)
            if (winding_numbers(points, corners[parts == outer]) > 0.75).any():
                raise InvalidInputError(
                    f"{name}: of its {count} closed parts, one reaches into another; unite them, and give the outer "
                    "surface alone"
                )


def winding_numbers(points: Array, corners: Array) -> Array:
    """Return how often closed triangles surround points, shape (n,): 1 within, 0 outside, one half on a face.

    Solid angles over 4 pi, by Van Oosterom and Strackee (1983), IEEE Trans. Biomed. Eng. 30, 125.
    """
    total = np.zeros(len(points))
    for first in range(0, len(points), 256):
        rays = corners[None] - points[first : first + 256, None, None, :]
        lengths = np.linalg.norm(rays, axis=3)
        a, b, c = rays[:, :, 0], rays[:, :, 1], rays[:, :, 2]
        la, lb, lc = lengths[:, :, 0], lengths[:, :, 1], lengths[:, :, 2]
        above = np.einsum("pti,pti->pt", a, np.cross(b, c))
        below = la * lb * lc
        for x, y, z in ((a, b, lc), (b, c, la), (c, a, lb)):
            below = below + np.einsum("pti,pti->pt", x, y) * z
        total[first : first + 256] = 2.0 * np.arctan2(above, below).sum(axis=1) / (4.0 * np.pi)
    return total
