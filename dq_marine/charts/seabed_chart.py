"""A seabed from depths on a regular grid, checked."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_number, real_numbers
from dq_marine.errors import InvalidInputError
from dq_marine.task.grounds import ChartSheet
from dq_marine.task.world.charts import charted

MOST_SAMPLES = 2**16
"""Of a chart, or of a grid of distances: each environment holds them all, and begins an episode with a copy."""

LEAST_SPACING, MOST_SPACING, DEEPEST = 1e-3, 1e4, 2e4
"""Of samples, both ways, and of a seabed [m]: the Mariana Trench has 11 km."""

STEEPEST = 2.0
"""Of a chart between two samples: beams that graze what is steeper are not followed to it."""


@dataclass(frozen=True, eq=False)
class SeabedChart:
    """A seabed from samples on a grid of squares. Between samples it is bilinear, beyond the edges it goes on level.

    Attributes:
        depths: [m], shape (rows, columns), two or more of each: row by row from south to north, in each from west to
            east. Where all are below 0 they are taken as heights over the surface, as most GeoTIFFs have them.
        spacing: between samples, both ways [m].
        name: for messages.

    Raises:
        InvalidInputError: depths are not finite, beyond the deepest sea, of both signs, too many, of another shape, or
            too steep; or the spacing is wrong.
    """

    depths: NDArray[np.float64]
    spacing: float
    name: str = "the chart"

    def __post_init__(self) -> None:
        """Check, and keep what was checked."""
        depths = checked_depths(real_numbers("depths", self.depths, "rows of depths"), self.name)
        spacing = finite_number("spacing", self.spacing, least=LEAST_SPACING, most=MOST_SPACING)
        self.__dict__.update(depths=depths, spacing=spacing)
        _check_slope(self)

    @property
    def sides(self) -> tuple[float, float]:
        """How far it reaches, north and east [m]."""
        rows, columns = self.depths.shape
        return (rows - 1) * self.spacing, (columns - 1) * self.spacing

    @functools.cached_property
    def sheet(self) -> ChartSheet:
        """Its numbers, as tasks take them."""
        rows, columns = self.depths.shape
        chart = charted(self.depths.tolist(), 0.0, 0.0, self.spacing)
        return ChartSheet(float(rows), float(columns), chart)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same seabed, whatever its name."""
        if not isinstance(other, SeabedChart):
            return NotImplemented
        return self.spacing == other.spacing and np.array_equal(self.depths, other.depths)

    def __hash__(self) -> int:
        """Return a number that equal charts share."""
        return hash((self.spacing, self.depths.tobytes()))

    def __repr__(self) -> str:
        """Return where it is from and how large it is."""
        rows, columns = self.depths.shape
        return f"SeabedChart({self.name!r}, {rows} x {columns} samples, {self.spacing:g} m apart)"


def checked_depths(given: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    """Return depths [m], turned from heights where all are below 0; see `SeabedChart`.

    Raises:
        InvalidInputError: they are of another shape, too many, not finite, too deep, or of both signs.
    """
    if given.ndim != 2 or min(given.shape) < 2:
        raise InvalidInputError(
            f"{name} has depths of shape {given.shape}; give rows and columns, two or more of each"
        )
    check_count(given.shape, name)
    bad = np.argwhere(~np.isfinite(given))
    if len(bad):
        row, column = bad[0].tolist()
        raise InvalidInputError(
            f"{name}: {len(bad):,} of its depths are not finite, the first in row {row} from the south and "
            f"column {column}, counted from 0; cut the chart, or fill its holes (GDAL: gdal_fillnodata)"
        )
    least, most = float(given.min()), float(given.max())
    if least <= 0.0 <= most:
        raise InvalidInputError(
            f"{name} has depths from {least:g} to {most:g} m; give depths that are all above 0, or heights all "
            "below 0: cut off the land"
        )
    depths = np.array(given if least > 0.0 else -given)
    if depths.max() > DEEPEST:
        raise InvalidInputError(
            f"{name} is {depths.max():g} m deep; give depths of at most {DEEPEST:g} m, and mark holes as such"
        )
    return depths


def check_count(shape: tuple[int, ...], name: str) -> None:
    """Check that a chart of a shape has no more samples than an environment holds.

    Raises:
        InvalidInputError: it has.
    """
    count = shape[0] * shape[1]
    if count > MOST_SAMPLES:
        each = next(
            step for step in range(2, count) if -(-shape[0] // step) * -(-shape[1] // step) <= MOST_SAMPLES
        )
        raise InvalidInputError(
            f"{name} has {shape[0]} x {shape[1]} = {count:,} samples; give at most {MOST_SAMPLES:,}: cut it, or take "
            f"one of {each} both ways (depths[::{each}, ::{each}]; GDAL: gdal_translate -outsize {100 / each:.3g}% 0)"
        )


def _check_slope(chart: SeabedChart) -> None:
    """Check that a chart is not so steep that beams do not find it."""
    steepest = chart.sheet.chart.steepest
    if steepest > STEEPEST:
        raise InvalidInputError(
            f"{chart.name} is up to {steepest:.3g} m deeper per metre; give one that is no steeper than {STEEPEST:g}: "
            "smooth it, or check its spacing and its unit"
        )
