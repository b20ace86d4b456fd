"""Fields of sampled numbers: a seabed from a table of depths, and any shape from a grid of its signed distances.

Between samples a depth is bilinear and a distance trilinear; beyond its edges a depth goes on as it is there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

from dq_marine.algebra.level import level_length
from dq_marine.algebra.selection import rounded, select
from dq_marine.algebra.table import Table, entry
from dq_marine.algebra.vector3 import Vector3, add_scaled, norm, scale, subtract
from dq_marine.task.world.seabed import LEAST_CLOSING

CHART_TRACING = 32
"""Steps of a beam to a charted seabed, which has no bend to go by: one in all where the beam points straight down."""


class Cell(NamedTuple):
    """Where a place is among samples, along one axis.

    Attributes:
        first: number of the sample before it.
        share: of the way from there to the next.
        beyond: how far the place is beyond the first or the last sample, in samples.
    """

    first: float
    share: float
    beyond: float


class Chart(NamedTuple):
    """A seabed: place of its first sample and distance between samples [m], bound of its slope, depths [m].

    The depths stand row by row, from south to north, and in each from west to east.
    """

    north: float
    east: float
    spacing: float
    steepest: float
    depths: Table


class DistanceGrid(NamedTuple):
    """A shape: place of the first sample and distance between samples [m], signed distances [m].

    The last index, along z, runs fastest. The whole shape is within the grid.
    """

    first: Vector3
    spacing: float
    distances: Table


class Charted(NamedTuple):
    """The functions of a chart of so many rows and columns.

    Attributes:
        depth: (chart, north, east) -> depth there [m].
        cast: (chart, origin, direction, reach) -> range along a ray [m].
        along: (chart, north, east, a level direction's parts) -> depth there [m], and its growth per metre that way.
    """

    depth: Callable[[Chart, float, float], float]
    cast: Callable[[Chart, Vector3, Vector3, float], float]
    along: Callable[[Chart, float, float, float, float], tuple[float, float]]


def make_chart(rows: int, columns: int) -> Charted:
    """Return the functions of a chart of so many rows and columns, two or more of each."""
    last_row, last_column, width = float(rows - 1), float(columns - 1), float(columns)

    def depth(chart: Chart, north: float, east: float) -> float:
        row = _cell((north - chart.north) / chart.spacing, last_row)
        column = _cell((east - chart.east) / chart.spacing, last_column)
        place = row.first * width + column.first
        south, farther = (
            _pair(chart.depths, place, column.share),
            _pair(chart.depths, place + width, column.share),
        )
        return _between(row.share, south, farther)

    def cast(chart: Chart, origin: Vector3, direction: Vector3, reach: float) -> float:
        # The height falls by the slope's bound on the level and by the beam's own sinking at most.
        closing = chart.steepest * level_length((direction[0], direction[1])) + direction[2]
        per_height = 1.0 / max(closing, LEAST_CLOSING)
        travelled = 0.0 * origin[0]
        for _ in range(CHART_TRACING):
            point = add_scaled(origin, travelled, direction)
            height = depth(chart, point[0], point[1]) - point[2]
            travelled = min(travelled + max(height, 0.0) * per_height, reach)
        return travelled

    def along(
        chart: Chart, north: float, east: float, way_north: float, way_east: float
    ) -> tuple[float, float]:
        row = _cell((north - chart.north) / chart.spacing, last_row)
        column = _cell((east - chart.east) / chart.spacing, last_column)
        place = row.first * width + column.first
        near, far = entry(chart.depths, place), entry(chart.depths, place + 1.0)
        beyond_near, beyond_far = (
            entry(chart.depths, place + width),
            entry(chart.depths, place + width + 1.0),
        )
        south, farther = (
            _between(column.share, near, far),
            _between(column.share, beyond_near, beyond_far),
        )
        # Beyond an edge nothing changes across it.
        northward = select(row.beyond == 0.0, farther - south, 0.0)
        eastward = select(
            column.beyond == 0.0, _between(row.share, far - near, beyond_far - beyond_near), 0.0
        )
        growth = (northward * way_north + eastward * way_east) / chart.spacing
        return _between(row.share, south, farther), growth

    return Charted(depth, cast, along)


def charted(depths: Sequence[Sequence[float]], north: float, east: float, spacing: float) -> Chart:
    """Return the chart of depths [m], row by row from the south, each from the west.

    Args:
        depths: two rows or more, of two numbers or more each, equally many.
        north: of the first sample [m].
        east: of the first sample [m].
        spacing: between samples, both ways [m].
    """
    along = max(abs(b - a) for row in depths for a, b in pairwise(row))
    across = max(abs(b - a) for low, high in pairwise(depths) for a, b in zip(low, high, strict=True))
    steepest = level_length((along, across)) / spacing
    return Chart(north, east, spacing, steepest, Table(float(one) for row in depths for one in row))


def make_grid_distance(norths: int, easts: int, downs: int) -> Callable[[DistanceGrid, Vector3], float]:
    """Return (grid, point) -> distance to the shape of a grid of so many samples along each axis, two or more.

    Outside the grid it is a lower bound: the way to the grid, or the distance where that ends, less that way.
    """
    last_x, last_y, last_z = float(norths - 1), float(easts - 1), float(downs - 1)
    row, layer = float(downs), float(easts * downs)

    def distance(grid: DistanceGrid, point: Vector3) -> float:
        off = scale(1.0 / grid.spacing, subtract(point, grid.first))
        x, y, z = _cell(off[0], last_x), _cell(off[1], last_y), _cell(off[2], last_z)
        place, samples = x.first * layer + y.first * row + z.first, grid.distances
        near = _between(y.share, _pair(samples, place, z.share), _pair(samples, place + row, z.share))
        beyond = place + layer
        far = _between(y.share, _pair(samples, beyond, z.share), _pair(samples, beyond + row, z.share))
        inside = _between(x.share, near, far)
        away = grid.spacing * norm((x.beyond, y.beyond, z.beyond))
        return select(away > 0.0, max(inside - away, away), inside)

    return distance


def sampled(
    distance: Callable[[Vector3], float], first: Vector3, spacing: float, counts: tuple[int, int, int]
) -> DistanceGrid:
    """Return the grid of a shape that is given by its signed distance [m], in plain Python.

    Args:
        distance: (point) -> signed distance, negative inside.
        first: the first sample [m].
        spacing: between samples [m].
        counts: of samples along the axes, two or more of each.
    """
    samples = (
        distance(add_scaled(first, spacing, (float(i), float(j), float(k))))
        for i in range(counts[0])
        for j in range(counts[1])
        for k in range(counts[2])
    )
    return DistanceGrid(first, spacing, Table(samples))


def _cell(place: float, last: float) -> Cell:
    """Return where a place is among samples 0 to `last`."""
    held = max(0.0, min(last, place))
    first = max(0.0, min(last - 1.0, rounded(held - 0.5)))
    return Cell(first, held - first, place - held)


def _pair(samples: Table, place: float, share: float) -> float:
    """Return what is between a sample and the next."""
    return _between(share, entry(samples, place), entry(samples, place + 1.0))


def _between(share: float, one: float, other: float) -> float:
    return one + share * (other - one)
