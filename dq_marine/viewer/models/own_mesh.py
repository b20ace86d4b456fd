"""A vehicle's own mesh, from an STL or a GLB file: read, put into body axes, and coloured."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.util.announce import announce
from dq_marine.util.extras import optional_library
from dq_marine.vehicles.appearance import Appearance
from dq_marine.viewer.meshes import Mesh, joined
from dq_marine.viewer.snapshot import FloatArray

MOST_TRIANGLES = 200_000
"""That a browser without a graphics card draws within a second, and that a replay can hold."""

SHARP = 0.6
"""Angle between triangles from which their common edge is one [rad]."""

KEPT = 8
"""Meshes in memory."""


@dataclass(frozen=True, eq=False)
class OwnMesh:
    """A mesh in body axes.

    Attributes:
        mesh: smooth but for sharp edges.
        colors: red, green and blue of its vertices within [0, 1], shape (n, 3).
    """

    mesh: Mesh
    colors: FloatArray


@functools.lru_cache(KEPT)
def own_mesh(appearance: Appearance) -> OwnMesh | None:
    """Read a vehicle's mesh; None, and a line that says why, where the file or a library that reads it is missing.

    A vehicle flies as well without: who got it from somebody else may not have the mesh.

    Raises:
        InvalidInputError: the file is no mesh, has no triangles or too many.
    """
    file = existing_file("appearance.file", appearance.file)
    if file is None:
        announce(f"{shown(appearance.file)} is not there: the vehicle is drawn by its kind")
        return None
    try:
        optional_library("the vehicle's own mesh", "scipy", "models")  # by which trimesh finds sharp edges
        library = optional_library("the vehicle's own mesh", "trimesh", "models")
    except MissingDependencyError as error:
        announce(f"the vehicle is drawn by its kind: {error}")
        return None
    parts = _stl_parts(library, file) if file.suffix.lower() == ".stl" else _glb_parts(library, file)
    triangles = sum(len(part.faces) for part in parts)
    if not 0 < triangles <= MOST_TRIANGLES:
        raise InvalidInputError(
            f"{file} has {triangles:,} triangles; give a mesh of 1 to {MOST_TRIANGLES:,}: a program for meshes can "
            "decimate it"
        )
    read = [_in_body_axes(library, part, appearance) for part in parts]
    return OwnMesh(joined([one.mesh for one in read]), np.vstack([one.colors for one in read]))


def _stl_parts(library: Any, file: Path) -> list[Any]:
    from dq_marine.meshes.stl import read_stl  # here: it brings all that makes vehicles of meshes

    corners = read_stl(file)
    return [library.Trimesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))]


def _glb_parts(library: Any, file: Path) -> list[Any]:
    """Return the surfaces of a GLB file, where its scene puts them; nothing is fetched from elsewhere."""
    try:
        with file.open("rb") as content:
            parts = library.load_scene(content, file_type="glb").dump()
    except Exception as error:  # what trimesh stumbles over in a damaged file has no class of its own
        raise InvalidInputError(
            f"{file} cannot be read as GLB ({type(error).__name__}: {shown(str(error))}); export it again"
        ) from error
    return [part for part in parts if isinstance(part, library.Trimesh)]


def _in_body_axes(library: Any, part: Any, appearance: Appearance) -> OwnMesh:
    if not np.isfinite(part.vertices).all():
        raise InvalidInputError(
            f"{appearance.file} has a coordinate that is not finite; export the mesh again"
        )
    part.visual = library.visual.ColorVisuals(part, vertex_colors=_colors(part, appearance))
    smooth = library.graph.smooth_shade(part, angle=SHARP, facet_minarea=None)
    to_body = appearance.rotation.T
    vertices = appearance.scale * smooth.vertices @ to_body + np.array(appearance.origin)
    triangles = np.asarray(smooth.faces, dtype=np.int64)
    mesh = Mesh(vertices, smooth.vertex_normals @ to_body, triangles)
    return OwnMesh(mesh, np.asarray(smooth.visual.vertex_colors[:, :3] / 255.0))


def _colors(part: Any, appearance: Appearance) -> NDArray[np.uint8]:
    """Return the colours of a surface's vertices, shape (n, 4): its own, or those of its texture, or the vehicle's."""
    count = len(part.vertices)
    if not part.visual.defined:
        return np.tile(np.array([*bytes.fromhex(appearance.color[1:]), 255], dtype=np.uint8), (count, 1))
    visual = part.visual.to_color() if part.visual.kind == "texture" else part.visual
    return np.asarray(np.broadcast_to(visual.vertex_colors, (count, 4)), dtype=np.uint8)
