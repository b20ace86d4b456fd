"""A solid from a mesh, as a grid of signed distances for tasks of one's own."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3
from dq_marine.charts.seabed_chart import MOST_SAMPLES
from dq_marine.charts.triangles import distances_to
from dq_marine.checks import finite_number, possible_path
from dq_marine.errors import InvalidInputError
from dq_marine.meshes.repair import closed_surface, winding_numbers
from dq_marine.meshes.stl import read_stl
from dq_marine.task.world.charts import DistanceGrid, make_grid_distance

MOST_PAIRS = 2**26
"""Of a sample and a triangle: as many distances take about a minute."""

LEAST_SPACING, MOST_SPACING = 1e-3, 1e3
"""Of samples [m]."""

MARGIN = 2
"""Samples around the box of a mesh, so that the solid is within the grid."""


@dataclass(frozen=True, eq=False)
class SolidChart:
    """Signed distances to a solid on a grid, negative inside it. Between samples they are trilinear.

    Attributes:
        distances: [m], shape (norths, easts, downs).
        first: place of the first sample [m], in the axes of the mesh.
        spacing: between samples, along each axis [m].
        name: for messages.
        triangles: of the mesh, for drawing, shape (n, 3, 3) [m].
        file: that it is from.
    """

    distances: NDArray[np.float64]
    first: Vector3
    spacing: float
    name: str
    triangles: NDArray[np.float64]
    file: str

    @classmethod
    def from_stl(cls, file: str | os.PathLike[str], spacing: float) -> SolidChart:
        """Return the chart of a closed surface in an STL file, whose coordinates are metres.

        Args:
            file: binary or ASCII.
            spacing: between samples, along each axis [m]; a detail that is smaller is not seen.

        Raises:
            InvalidInputError: there is no such file, it is no STL file, its surface is not closed, the solid is smaller
                than the spacing, or there would be too many samples, or too many of them for its triangles.
        """
        spacing = finite_number("spacing", spacing, least=LEAST_SPACING, most=MOST_SPACING)
        path = possible_path("file", file)
        surface, _ = closed_surface(read_stl(path), path.name)
        extent, low = surface.extent, surface.vertices.min(axis=0)
        if float(extent.min()) < spacing:
            raise InvalidInputError(
                f"spacing = {spacing:g} is more than the least side of {path.name}, {float(extent.min()):g} m; give "
                "one below that"
            )
        counts = np.ceil(extent / spacing).astype(int) + 1 + 2 * MARGIN
        _check_counts(counts, len(surface.triangles), spacing, path.name)
        first = low - MARGIN * spacing
        axes = [first[axis] + spacing * np.arange(counts[axis]) for axis in range(3)]
        points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        inside = winding_numbers(points, surface.corners) > 0.5
        distances = distances_to(points, surface.corners)
        signed = np.where(inside, -distances, distances).reshape(counts)
        x, y, z = (float(part) for part in first)
        return cls(signed, (x, y, z), spacing, path.name, surface.corners, str(path))

    @functools.cached_property
    def grid(self) -> DistanceGrid:
        """Its numbers, as a task's parameters take them."""
        return DistanceGrid(self.first, self.spacing, Table(self.distances.ravel().tolist()))

    @property
    def numbers(self) -> DistanceGrid:
        """The same, as a `dq_marine.Solid` asks for it."""
        return self.grid

    @property
    def distance(self) -> Callable[[DistanceGrid, Vector3], float]:
        """The pure function (grid, point) -> distance [m], for the formulas of a task; see `make_grid_distance`."""
        return _grid_distance(*self.distances.shape)


@functools.cache
def _grid_distance(norths: int, easts: int, downs: int) -> Callable[[DistanceGrid, Vector3], float]:
    return make_grid_distance(norths, easts, downs)


def _check_counts(counts: NDArray[np.int64], triangles: int, spacing: float, name: str) -> None:
    """Check that a grid is not too large to be held, nor to be filled."""
    samples = int(np.prod(counts.astype(float)))
    if samples > MOST_SAMPLES:
        coarser = spacing * (samples / MOST_SAMPLES) ** (1.0 / 3.0)
        shape = " x ".join(map(str, counts.tolist()))
        raise InvalidInputError(
            f"spacing = {spacing:g} gives {name} {shape} = {samples:,} samples; at most {MOST_SAMPLES:,} are held: "
            f"give about {1.1 * coarser:.2g} or more"
        )
    if samples * triangles > MOST_PAIRS:
        raise InvalidInputError(
            f"{name} has {triangles:,} triangles, too many for {samples:,} samples; give at most "
            f"{MOST_PAIRS // samples:,} (in Blender: Decimate), or a larger spacing"
        )
