"""A closed surface of triangles, with the integrals over what it encloses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAME = 1e-5
"""Points nearer than this part of the size are the same: coordinates in STL files have seven digits."""

Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles whose corners run anticlockwise when seen from outside.

    Attributes:
        vertices: shape (n, 3) [m].
        triangles: vertex numbers, shape (m, 3).
    """

    vertices: Array
    triangles: Integers

    @property
    def corners(self) -> Array:
        """Corners of the triangles [m], shape (m, 3, 3)."""
        return np.asarray(self.vertices[self.triangles])

    @property
    def extent(self) -> Array:
        """Length, width and height of the box around it [m], shape (3,)."""
        return np.asarray(self.vertices.max(axis=0) - self.vertices.min(axis=0))

    def moved(self, rotation: Array, scale: float, shift: Array) -> Surface:
        """Return it turned, scaled and then shifted: scale R x + shift, R of determinant 1."""
        return Surface(scale * self.vertices @ rotation.T + shift, self.triangles)


def mirror_planes(surface: Surface) -> tuple[bool, bool]:
    """Return whether every corner has a mirror image across the planes x = 0 and y = 0."""
    grid = SAME * float(surface.extent.max())
    return tuple(_same_points(surface.vertices, axis, grid) for axis in (0, 1))  # type: ignore[return-value]


def _same_points(points: Array, axis: int, grid: float) -> bool:
    image = points.copy()
    image[:, axis] *= -1.0
    ordered = [one[np.lexsort(np.round(one / grid).T)] for one in (points, image)]
    return bool(np.abs(ordered[0] - ordered[1]).max() <= 2.0 * grid)


def area_vectors(corners: Array) -> Array:
    """Return normals as long as the triangles are large [m^2], shape (m, 3)."""
    return np.asarray(0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


@dataclass(frozen=True)
class Solid:
    """What a closed surface encloses.

    Attributes:
        volume: [m^3], negative if the surface is inside out.
        center: its centroid [m], shape (3,).
        second_moments: integral of (x - c)(x - c)^T over the volume [m^5], shape (3, 3).
    """

    volume: float
    center: Array
    second_moments: Array

    @property
    def squared_gyration(self) -> Array:
        """Inertia about the centroid over the mass, of a uniform filling [m^2], shape (3, 3)."""
        spread = self.second_moments / self.volume
        return np.asarray(np.trace(spread) * np.eye(3) - spread)


def enclosed(corners: Array) -> Solid:
    """Return volume, centroid and second moments of what closed triangles enclose, exactly.

    A sum over tetrahedra between each triangle and a point in the middle, with signs. For a tetrahedron with a corner
    at the origin and the others a, b, c, and s = a + b + c: V = det/6, int x = V s/4, int x x^T = V/20 (s s^T + a a^T +
    b b^T + c c^T).
    """
    middle = corners.reshape(-1, 3).mean(axis=0)
    local = corners - middle
    volumes = np.einsum("mi,mi->m", local[:, 0], np.cross(local[:, 1], local[:, 2])) / 6.0
    sums = local.sum(axis=1)
    volume = float(volumes.sum())
    first = volumes @ sums / 4.0
    squares = np.einsum("m,mi,mj->ij", volumes, sums, sums) + np.einsum(
        "m,mki,mkj->ij", volumes, local, local
    )
    center = first / volume if volume else first
    return Solid(volume, middle + center, squares / 20.0 - volume * np.outer(center, center))
