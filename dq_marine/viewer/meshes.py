"""Triangle meshes of simple solids: cuboids, bodies of revolution, rounded blocks, plates.

Triangles run anticlockwise when seen from outside, and normals point outwards.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.viewer.placement import Placement
from dq_marine.viewer.snapshot import FloatArray

Profile = Sequence[tuple[float, float]]
"""Points (distance from the axis, place along the axis) [m]."""

SECTORS = 18
"""Facets around a body of revolution."""

BLOCK_RINGS = 12
BLOCK_SECTORS = 24


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface of triangles.

    Attributes:
        vertices: shape (n, 3) [m].
        normals: unit vectors, shape (n, 3).
        triangles: vertex numbers, shape (m, 3).
    """

    vertices: FloatArray
    normals: FloatArray
    triangles: NDArray[np.int64]

    def placed(self, placement: Placement) -> Mesh:
        """The mesh in the parent frame of a placement."""
        rotation = placement.rotation_matrix()
        moved = placement.scale * self.vertices @ rotation.T + np.array(placement.position)
        return Mesh(moved, self.normals @ rotation.T, self.triangles)


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    return Mesh(
        np.vstack([mesh.vertices for mesh in meshes]),
        np.vstack([mesh.normals for mesh in meshes]),
        np.vstack([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=True)]),
    )


def cuboid(along_x: float, along_y: float, along_z: float) -> Mesh:
    """A box centred at the origin; edge lengths [m]."""
    half = np.array([along_x, along_y, along_z]) / 2
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    faces = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            corners = np.empty((4, 3))
            corners[:, axis] = side
            corners[:, (axis + 1) % 3] = square[:, 0] * side
            corners[:, (axis + 2) % 3] = square[:, 1]
            faces.append(flat_polygon(corners * half))
    return joined(faces)


def tetrahedron(radius: float) -> Mesh:
    """A regular tetrahedron centred at the origin; distance of its corners [m]."""
    corners = (
        radius
        / math.sqrt(3.0)
        * np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
    )
    return joined([flat_polygon(corners[face]) for face in ([0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2])])


def flat_polygon(corners: FloatArray) -> Mesh:
    """A flat, convex polygon, seen from the side where its corners (n, 3) run anticlockwise."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normals = np.tile(normal / np.linalg.norm(normal), (len(corners), 1))
    fan = np.array([(0, i, i + 1) for i in range(1, len(corners) - 1)])
    return Mesh(corners, normals, fan)


def plate(outline: Sequence[tuple[float, float]], thickness: float) -> Mesh:
    """A flat plate in the xy plane, centred at z = 0.

    Args:
        outline: corners (x, y) [m], anticlockwise from +z, of a polygon that can be seen entirely
            from its first corner.
        thickness: along z [m].
    """
    flat = np.array(outline, dtype=np.float64)
    upper = np.column_stack([flat, np.full(len(flat), thickness / 2)])
    lower = upper * [1.0, 1.0, -1.0]
    rim = [flat_polygon(np.array([lower[i - 1], lower[i], upper[i], upper[i - 1]])) for i in range(len(flat))]
    # The fan of the lower side starts at the same corner, and runs the other way round.
    return joined([flat_polygon(upper), flat_polygon(np.roll(lower[::-1], 1, axis=0)), *rim])


def revolved(profile: Profile, *, smooth: bool = False) -> Mesh:
    """A body of revolution about y.

    Args:
        profile: the outline; the outside lies to the right of its direction of travel, so that a
            profile which goes up along +y encloses the axis.
        smooth: round off the shading along the profile; otherwise every point of it is an edge.
    """
    points = np.array(profile, dtype=np.float64)
    steps = np.diff(points, axis=0)
    outward = np.column_stack([steps[:, 1], -steps[:, 0]])
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    if smooth:
        return _swept(points, _averaged(outward))
    bands = zip(points[:-1], points[1:], outward, strict=True)
    return joined([_swept(np.array([a, b]), np.array([n, n])) for a, b, n in bands])


def cylinder(radius: float, height: float, *, top_radius: float | None = None) -> Mesh:
    """A closed cylinder, or a cone towards `top_radius`, along y, centred at the origin [m]."""
    top = radius if top_radius is None else top_radius
    half = height / 2
    profile = [(0.0, -half), (radius, -half), (top, half)]
    return revolved([*profile, (0.0, half)] if top > 0.0 else profile)


def sphere(radius: float) -> Mesh:
    """A sphere centred at the origin; radius [m]."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, 13)
    return revolved([(radius * math.cos(a), radius * math.sin(a)) for a in angles], smooth=True)


def rounded_block(along_x: float, along_y: float, along_z: float, roundness: float) -> Mesh:
    """A superellipsoid: a cuboid with soft edges, centred at the origin.

    Args:
        along_x: size along x [m].
        along_y: size along y [m].
        along_z: size along z [m].
        roundness: 1 for an ellipsoid, towards 0 for a sharp cuboid.
    """
    latitude = np.linspace(-np.pi / 2, np.pi / 2, BLOCK_RINGS)[:, None]
    longitude = np.linspace(-np.pi, np.pi, BLOCK_SECTORS)[None, :]

    def surface(exponent: float) -> FloatArray:
        cos_lat, sin_lat = _power(np.cos(latitude), exponent), _power(np.sin(latitude), exponent)
        x = cos_lat * _power(np.cos(longitude), exponent)
        y = cos_lat * _power(np.sin(longitude), exponent)
        z = np.broadcast_to(sin_lat, x.shape)
        return np.stack([x, y, z], axis=-1).reshape(-1, 3)

    half = np.array([along_x, along_y, along_z]) / 2
    # The normal of a superellipsoid is one of the dual exponent, stretched by the inverse sizes.
    normals = surface(2.0 - roundness) / half
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    triangles = grid_triangles(BLOCK_RINGS, BLOCK_SECTORS)
    return Mesh(surface(roundness) * half, normals, triangles)


def grid_triangles(rows: int, columns: int) -> NDArray[np.int64]:
    """Two triangles for every cell of a grid of vertices numbered row by row."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)[None, :]).ravel()
    right, below = corner + 1, corner + columns
    first = np.column_stack([corner, right, below])
    second = np.column_stack([right, below + 1, below])
    return np.vstack([first, second])


def _swept(points: FloatArray, normals: FloatArray) -> Mesh:
    """The surface that a line of points (n, 2) and its normals (n, 2) sweep around the y axis."""
    around = np.linspace(0.0, 2 * np.pi, SECTORS + 1)

    def turned(pairs: FloatArray) -> FloatArray:
        away, along = pairs[:, :1], pairs[:, 1:]
        turns = [away * np.sin(around), along * np.ones_like(around), away * np.cos(around)]
        return np.stack(turns, axis=-1).reshape(-1, 3)

    return Mesh(turned(points), turned(normals), grid_triangles(len(points), SECTORS + 1))


def _averaged(segment_normals: FloatArray) -> FloatArray:
    """Normals at the points of a profile from those of the segments between them."""
    ends = np.vstack([segment_normals[:1], segment_normals, segment_normals[-1:]])
    means = ends[:-1] + ends[1:]
    unit: FloatArray = means / np.linalg.norm(means, axis=1, keepdims=True)
    return unit


def _power(base: FloatArray, exponent: float) -> FloatArray:
    signed: FloatArray = np.sign(base) * np.abs(base) ** exponent
    return signed
