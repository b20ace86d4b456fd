"""Fields of sampled numbers: a seabed from a table of depths, and any shape from a grid of its signed distances.

Between samples a depth is bilinear and a distance trilinear; beyond its edges a depth goes on as it is there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

from dq_marine.algebra.level import level_length
from dq_marine.algebra.selection import every, rounded, select
from dq_marine.algebra.table import Table, entry
from dq_marine.algebra.vector3 import Vector3, add_scaled, norm, scale, subtract
from dq_marine.task.world.seabed import LEAST_CLOSING

CHART_TRACING = 32
"""Steps of a beam to a charted seabed: each to the end of a patch, to the seabed, or as far as the slope lets it."""

FAR = 1e9
"""Metres that no beam goes."""


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


class Patch(NamedTuple):
    """A chart from a place on, a level way t along a beam [m]: depth + growth t + bend t^2 as far as the patch goes.

    Attributes:
        depth: [m].
        growth: per metre.
        bend: [1/m].
        ends: where the way comes to other samples [m].
    """

    depth: float
    growth: float
    bend: float
    ends: float


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

    def patch_at(chart: Chart, north: float, east: float, way_north: float, way_east: float) -> Patch:
        row = _cell((north - chart.north) / chart.spacing, last_row)
        column = _cell((east - chart.east) / chart.spacing, last_column)
        place = row.first * width + column.first
        near, far = entry(chart.depths, place), entry(chart.depths, place + 1.0)
        next_near, next_far = entry(chart.depths, place + width), entry(chart.depths, place + width + 1.0)
        south, north_side = _between(column.share, near, far), _between(column.share, next_near, next_far)
        north_rate, east_rate = way_north / chart.spacing, way_east / chart.spacing
        ends = min(_until_left(row, north_rate), _until_left(column, east_rate))
        # Beyond an edge nothing changes across it.
        north_rate = select(row.beyond == 0.0, north_rate, 0.0)
        east_rate = select(column.beyond == 0.0, east_rate, 0.0)
        growth = north_rate * (north_side - south)
        growth = growth + east_rate * _between(row.share, far - near, next_far - next_near)
        bend = north_rate * east_rate * ((next_far - next_near) - (far - near))
        return Patch(_between(row.share, south, north_side), growth, bend, ends)

    def along(
        chart: Chart, north: float, east: float, way_north: float, way_east: float
    ) -> tuple[float, float]:
        patch = patch_at(chart, north, east, way_north, way_east)
        return patch.depth, patch.growth

    def cast(chart: Chart, origin: Vector3, direction: Vector3, reach: float) -> float:
        # The height falls by the slope's bound on the level and by the beam's own sinking at most.
        closing = chart.steepest * level_length((direction[0], direction[1])) + direction[2]
        per_height = 1.0 / max(closing, LEAST_CLOSING)
        travelled = 0.0 * origin[0]
        for _ in range(CHART_TRACING):
            point = add_scaled(origin, travelled, direction)
            patch = patch_at(chart, point[0], point[1], direction[0], direction[1])
            height = max(patch.depth - point[2], 0.0)
            met = _first_fall(height, patch.growth - direction[2], patch.bend)
            onward = max(height * per_height, min(met, patch.ends))
            before, travelled = travelled, min(travelled + onward, reach)
            # A step follows from the way so far alone: after one of no length, those that are left would have none.
            if every(travelled == before):
                break
        return travelled

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


def _until_left(cell: Cell, rate: float) -> float:
    """Return how far a beam goes until it leaves a cell [m], or comes to the first; its rate is in cells per metre."""
    slowest = 1.0 / FAR  # a beam that is slower across a cell stays in it, though it may run along its edge
    inside = select(rate > slowest, 1.0 - cell.share, select(rate < -slowest, cell.share, FAR))
    outside = select(cell.beyond * rate < 0.0, abs(cell.beyond), FAR)
    return select(cell.beyond == 0.0, inside, outside) / max(abs(rate), slowest)


def _first_fall(height: float, growth: float, bend: float) -> float:
    """Return the first t of height + growth t + bend t^2 = 0 [m], without a difference; `FAR` if there is none.

    Press et al. 2007, Numerical Recipes, 5.6.
    """
    under = growth * growth - 4.0 * bend * height
    spread = math.sqrt(max(under, 0.0)) - growth
    met = (under >= 0.0) & (spread > 0.0)
    return select(met, 2.0 * height / max(spread, 1.0 / FAR), FAR)


def _pair(samples: Table, place: float, share: float) -> float:
    """Return what is between a sample and the next."""
    return _between(share, entry(samples, place), entry(samples, place + 1.0))


def _between(share: float, one: float, other: float) -> float:
    return one + share * (other - one)
