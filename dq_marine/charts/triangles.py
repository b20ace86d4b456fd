"""Distances from points to triangles."""

from __future__ import annotations

import numpy as np

from dq_marine.meshes.surface import Array

PAIRS = 2**20
"""Of a point and a triangle, computed at a time: some hundred megabytes."""


def distances_to(points: Array, corners: Array) -> Array:
    """Return the distance of each point to the nearest of some triangles [m], shape (n,).

    To a triangle it is that to its plane, where the foot is within it, and else that to the nearest of its sides.

    Args:
        points: [m], shape (n, 3).
        corners: of the triangles, which have areas [m], shape (m, 3, 3).
    """
    found = np.empty(len(points))
    step = max(1, PAIRS // len(corners))
    for first in range(0, len(points), step):
        found[first : first + step] = _distances(points[first : first + step], corners)
    return found


def _distances(points: Array, corners: Array) -> Array:
    """Return the least distance of each point, for few of them at a time."""
    sides = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(sides[:, 0], sides[:, 1])
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    within = np.ones((len(points), len(corners)), dtype=bool)
    squared = np.full((len(points), len(corners)), np.inf)
    for corner in range(3):
        side = sides[:, corner]
        off = points[:, None, :] - corners[None, :, corner]
        share = np.clip(np.einsum("pti,ti->pt", off, side) / np.einsum("ti,ti->t", side, side), 0.0, 1.0)
        beside = off - share[:, :, None] * side
        squared = np.minimum(squared, np.einsum("pti,pti->pt", beside, beside))
        within &= np.einsum("pti,ti->pt", off, np.cross(normals, side)) >= 0.0
    height = np.einsum("pti,ti->pt", points[:, None, :] - corners[None, :, 0], normals)
    least: Array = np.sqrt(np.where(within, height * height, squared).min(axis=1))
    return least
