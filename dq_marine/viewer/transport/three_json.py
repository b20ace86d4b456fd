"""three.js objects as JSON: the language in which meshcat's page is told what to draw.

Format: https://github.com/mrdoob/three.js/wiki/JSON-Object-Scene-format-4, three.js release 132.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.viewer.libraries import drawing_library
from dq_marine.viewer.meshes import Mesh, joined
from dq_marine.viewer.snapshot import FloatArray

Json = dict[str, Any]

METADATA: Json = {"version": 4.5, "type": "Object"}
DOUBLE_SIDED = 2

FLOAT32_ARRAY = 0x17
UINT32_ARRAY = 0x16
"""MessagePack extension codes that the page turns into JavaScript typed arrays."""


@dataclass(frozen=True)
class Look:
    """How surfaces look, apart from their colour.

    Attributes:
        opacity: 1 for solid; below 1 it does not hide what is behind it.
        shininess: sharpness of the highlight; 0 for a dull surface.
        lit: otherwise it is shown in its plain colour, whatever the light.
        foggy: it fades into the water with distance.
        both_sides: it can be seen from its back, too.
        yielding: where it coincides with something else, that is seen in its place.
        on_top: it is seen through everything that is before it.
    """

    opacity: float = 1.0
    shininess: float = 40.0
    lit: bool = True
    foggy: bool = True
    both_sides: bool = False
    yielding: bool = False
    on_top: bool = False

    def material(self) -> Json:
        """As a three.js material that takes its colours from the vertices."""
        material: Json = {
            "type": "MeshPhongMaterial" if self.lit else "MeshBasicMaterial",
            "opacity": self.opacity,
            "transparent": self.opacity < 1.0,
            "depthWrite": self.opacity >= 1.0,
            "fog": self.foggy,
            "vertexColors": True,
        }
        if self.lit:
            material["shininess"] = self.shininess
            material["specular"] = 0x333333 if self.shininess else 0x000000
        if self.both_sides:
            material["side"] = DOUBLE_SIDED
        if self.on_top:
            material |= {"depthTest": False, "transparent": True}  # what is transparent is drawn last
        if self.yielding:
            material |= {"polygonOffset": True, "polygonOffsetFactor": 2.0, "polygonOffsetUnits": 8.0}
        return material


@dataclass(frozen=True, eq=False)
class Painted:
    """A mesh in one colour.

    Attributes:
        mesh: the surface, in the frame of the thing it is a part of.
        color: 0xRRGGBB.
    """

    mesh: Mesh
    color: int


def painted_surface(
    path: str, parts: Sequence[Painted], look: Look, user_data: Mapping[str, Any] | None = None
) -> Json:
    """One surface of several painted meshes: a single object is drawn much faster than many; see `surface`."""
    colors = [np.tile(rgb(part.color), (len(part.mesh.vertices), 1)) for part in parts]
    return surface(path, joined([part.mesh for part in parts]), np.vstack(colors), look, user_data)


def surface(
    path: str,
    mesh: Mesh,
    colors: FloatArray,
    look: Look,
    user_data: Mapping[str, Any] | None = None,
) -> Json:
    """A surface.

    Args:
        path: where it will be drawn; three.js wants a unique name.
        mesh: vertices, normals and triangles.
        colors: red, green, blue at the vertices, shape (n, 3), within [0, 1].
        look: of the whole surface.
        user_data: for the page to read.
    """
    geometry = _geometry(position=mesh.vertices, normal=mesh.normals, color=colors)
    geometry["data"]["index"] = _typed_array(mesh.triangles, np.uint32)
    drawn = _object(path, "Mesh", geometry, look.material(), user_data)
    if look.on_top:
        drawn["object"]["renderOrder"] = 1
    return drawn


def polyline(path: str, points: FloatArray, color: int, user_data: Mapping[str, Any] | None = None) -> Json:
    """A line, one pixel wide, through points of shape (n, 3) [m], with data for the page to read."""
    material = {"type": "LineBasicMaterial", "color": color, "fog": False}
    return _object(path, "Line", _geometry(position=points), material, user_data)


def line_segments(path: str, user_data: Mapping[str, Any]) -> Json:
    """Lines, one pixel wide, that the page lays and colours by the data; of no extent before."""
    material = {
        "type": "LineBasicMaterial",
        "vertexColors": True,
        "transparent": True,
        "depthWrite": False,
        "fog": False,
    }
    return _object(path, "LineSegments", _geometry(position=np.zeros((2, 3))), material, user_data)


def bare_object(kind: str, **properties: Any) -> Json:
    """An object without a surface, such as a lamp or a camera."""
    return {"metadata": METADATA, "object": {"uuid": kind, "type": kind, **properties}}


def rgb(color: int) -> FloatArray:
    """Red, green and blue within [0, 1] of 0xRRGGBB."""
    return np.array([color >> 16 & 0xFF, color >> 8 & 0xFF, color & 0xFF]) / 255.0


def packed_floats(values: NDArray[np.floating[Any]]) -> Any:
    """Numbers as a JavaScript Float32Array, row after row."""
    return drawing_library("umsgpack").Ext(FLOAT32_ARRAY, values.astype("<f4").tobytes())


def _object(
    path: str,
    kind: str,
    geometry: Json,
    material: Json,
    user_data: Mapping[str, Any] | None = None,
) -> Json:
    names = {"geometry": f"{path}:geometry", "material": f"{path}:material"}
    return {
        "metadata": METADATA,
        "geometries": [{"uuid": names["geometry"], **geometry}],
        "materials": [{"uuid": names["material"], **material}],
        "object": {"uuid": path, "type": kind, "userData": dict(user_data or {}), **names},
    }


def _geometry(**attributes: FloatArray) -> Json:
    """Per-vertex data of shape (n, 3), by three.js' names."""
    packed = {name: _typed_array(values, np.float32) for name, values in attributes.items()}
    return {"type": "BufferGeometry", "data": {"attributes": packed}}


def _typed_array(values: NDArray[Any], kind: type[np.float32] | type[np.uint32]) -> Json:
    """Rows of an array as a JavaScript typed array; an index is read one number at a time."""
    floats = kind is np.float32
    code = FLOAT32_ARRAY if floats else UINT32_ARRAY
    data = values.astype(np.dtype(kind).newbyteorder("<")).tobytes()
    return {
        "itemSize": 3 if floats else 1,
        "type": "Float32Array" if floats else "Uint32Array",
        "array": drawing_library("umsgpack").Ext(code, data),
        "normalized": False,
    }
