"""Kinds of ground that a vehicle flies over: waves that each episode draws, or a chart on which it draws a place."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.task.ground_flight import GroundFlight
from dq_marine.task.world.beams import Cast
from dq_marine.task.world.charts import Chart, make_chart
from dq_marine.task.world.seabed import WAVE_DRAWS, make_seabed


class ChartSheet(NamedTuple):
    """A chart as it was read, its first sample at the origin; numbers of its rows and columns."""

    rows: float
    columns: float
    chart: Chart


class ChartPlace(NamedTuple):
    """What an episode remembers of a chart: where its first sample is [m]."""

    north: float
    east: float


class Grounds(NamedTuple):
    """The functions of a kind of ground. What they call a ground is that which `whole` returns.

    Attributes:
        drawn: (flight, course of the way [rad], its length [m], uniforms, index) -> what an episode remembers of its
            ground.
        whole: (flight, what is remembered) -> the ground.
        depth: (ground, north, east) -> depth there [m].
        cast: (ground, origin, direction, reach) -> range along a ray [m].
        along: (ground, north, east, a level direction's parts) -> depth there [m], and its growth per metre that way.
    """

    drawn: Callable[[GroundFlight, float, float, tuple[float, ...], int], Any]
    whole: Callable[[GroundFlight, Any], Any]
    depth: Callable[[Any, float, float], float]
    cast: Cast
    along: Callable[[Any, float, float, float, float], tuple[float, float]]


@functools.cache
def make_wavy_ground(waves: int) -> Grounds:
    """Return the functions of a seabed of so many waves, of which an episode draws all; see `make_seabed`."""
    seabed = make_seabed(waves)
    drawn_waves = seabed.drawn

    def drawn(
        flight: GroundFlight, course: float, length: float, uniforms: tuple[float, ...], index: int
    ) -> Any:
        return drawn_waves(flight.depth, flight.slope, flight.wave, uniforms, index)

    def whole(flight: GroundFlight, remembered: Any) -> Any:
        return remembered

    return Grounds(drawn, whole, seabed.depth, seabed.cast, seabed.along)


@functools.cache
def make_charted_ground(rows: int, columns: int) -> Grounds:
    """Return the functions of a seabed from a chart of so many rows and columns, which is as long as any way.

    An episode draws where on the chart its way is, by two uniform numbers; all of the way is on it.
    """
    charted = make_chart(rows, columns)

    def drawn(
        flight: GroundFlight, course: float, length: float, uniforms: tuple[float, ...], index: int
    ) -> Any:
        spacing = flight.sheet.chart.spacing
        north = _first_sample(spacing * (rows - 1), length * math.cos(course), uniforms[index])
        east = _first_sample(spacing * (columns - 1), length * math.sin(course), uniforms[index + 1])
        return ChartPlace(north, east)

    def whole(flight: GroundFlight, remembered: Any) -> Any:
        chart = flight.sheet.chart
        return Chart(remembered.north, remembered.east, chart.spacing, chart.steepest, chart.depths)

    return Grounds(drawn, whole, charted.depth, charted.cast, charted.along)


def _first_sample(side: float, way: float, uniform: float) -> float:
    """Return where a chart's first sample is along an axis [m], so that 0 and `way` are on its side."""
    least, most = max(0.0, -way), side - max(0.0, way)
    return -(least + (most - least) * uniform)


def ground_draws(waves: int) -> int:
    """Return how many uniform numbers a seabed of so many waves takes; a place on a chart takes fewer."""
    return waves * WAVE_DRAWS


def grounds_of(flight: GroundFlight, waves: int) -> Grounds:
    """Return the kind of ground of an episode, in plain Python: by its chart, or else of so many waves."""
    if not flight.sheet:
        return make_wavy_ground(waves)
    return make_charted_ground(int(flight.sheet.rows), int(flight.sheet.columns))


def ground_of(flight: GroundFlight, remembered: Any, waves: int) -> tuple[Callable[..., float], Any]:
    """Return the function of depth of an episode's ground, and that ground, in plain Python.

    Args:
        flight: says by which chart, if any.
        remembered: what the episode remembers of its ground.
        waves: of a seabed without a chart.
    """
    kind = grounds_of(flight, waves)
    return kind.depth, kind.whole(flight, remembered)
