"""How a vehicle looks, if its file names a mesh of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from dq_marine.physics.fields import Table, Vector3
from dq_marine.physics.implausible import Implausible

DIRECTIONS: dict[str, tuple[float, float, float]] = {
    "f": (1.0, 0.0, 0.0),
    "a": (-1.0, 0.0, 0.0),
    "s": (0.0, 1.0, 0.0),
    "l": (0.0, -1.0, 0.0),
    "d": (0.0, 0.0, 1.0),
    "u": (0.0, 0.0, -1.0),
}
"""Forward, aft, starboard, left (to port), down and up in body axes."""

USUAL_AXES = {".stl": "flu", ".glb": "luf"}
"""By the ending of a mesh's file: of CAD programs, and of glTF 2.0 (Khronos Group, section 3.4)."""

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
"""In the units that a mesh may be in."""


def axes_rotation(axes: str) -> NDArray[np.float64]:
    """Return the matrix from axes to body axes, shape (3, 3).

    Args:
        axes: where x, y and z point, three of the letters of `DIRECTIONS`.
    """
    return np.array([DIRECTIONS[letter] for letter in axes]).T


class Appearance(Table):
    """A mesh that is drawn in place of the picture by kind. It has no part in the physics.

    Attributes:
        file: of the mesh, ending in .stl or .glb; in a vehicle's file its path from there.
        unit: of the mesh.
        axes: where the mesh's x, y and z point, three of f(orward), a(ft), s(tarboard), l(eft: to port), u(p), d(own);
            left out, the usual ones of the format: "flu" of STL, "luf" of GLB.
        origin: where the mesh's origin is from the body origin, in body axes [m].
        color: of what has none in the mesh, as "#rrggbb".
    """

    file: Annotated[str, Field(min_length=1)]
    unit: Literal["m", "cm", "mm", "in", "ft"] = "m"
    axes: Annotated[str, Field(pattern="^[faslud]{3}$")] | None = None
    origin: Vector3 = (0.0, 0.0, 0.0)
    color: Annotated[str, Field(pattern="^#[0-9a-fA-F]{6}$")] = "#f7be0a"

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        ending = Path(self.file).suffix.lower()
        if ending not in USUAL_AXES:
            raise Implausible(
                "appearance.file", repr(self.file), f"it ends in {ending!r}", "give a mesh in STL or GLB"
            )
        if self.axes is not None and not np.isclose(np.linalg.det(axes_rotation(self.axes)), 1.0):
            raise Implausible(
                "appearance.axes",
                repr(self.axes),
                "three directions at right angles, right-handed, are needed",
                'give such as "flu" (x forward, y to port, z up) or "fsd"',
            )
        return self

    @property
    def rotation(self) -> NDArray[np.float64]:
        """From the mesh's axes to body axes, shape (3, 3)."""
        return axes_rotation(self.axes or USUAL_AXES[Path(self.file).suffix.lower()])

    @property
    def scale(self) -> float:
        """Metres in the mesh's unit."""
        return METRES[self.unit]
