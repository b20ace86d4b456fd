"""The picture of a turning circle."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.manoeuvres.canvas import (
    GUIDE_COLOUR,
    HEADING_COLOUR,
    HELM_COLOUR,
    LEGEND,
    MARK_COLOUR,
    SPEED_COLOUR,
    draw_helm,
    draw_track,
    measure,
    new_figure,
    over_time,
)
from dq_marine.manoeuvres.sides import SIGNS
from dq_marine.manoeuvres.turning_circle import TurningCircle
from dq_marine.util.angle_lines import broken_at_jumps
from dq_marine.util.plot_style import PURPLE
from dq_marine.util.readable import readable

Array = NDArray[np.float64]

HULLS = 19
GAP = 0.16
"""Between the track and what is measured beside it, over the tactical diameter."""


def draw(result: TurningCircle) -> Any:
    """Return the figure: the track with its measures, and how rate of turn, speed and angles went."""
    figure = new_figure(
        result, f"turning circle to {result.side}, helm {100.0 * float(result.settings['helm']):g} %"
    )
    grid = figure.add_gridspec(3, 2, width_ratios=[1.25, 1.0])
    track = figure.add_subplot(grid[:, 0])
    draw_track(track, result, HULLS)
    _draw_measures(track, result)
    panels = [figure.add_subplot(grid[0, 1])]
    panels += [figure.add_subplot(grid[row, 1], sharex=panels[0]) for row in (1, 2)]
    _draw_rates(panels, result)
    return figure


def _draw_measures(axes: Any, result: TurningCircle) -> None:
    """Draw advance, transfer, tactical diameter and, if the turn became steady, its circle."""
    sign, steady = SIGNS[result.side], result.steady
    if steady is not None:
        ahead, aside = steady.centre
        if steady.settled:
            angle = np.linspace(0.0, 2.0 * np.pi, 181)
            axes.plot(
                sign * aside + steady.radius * np.cos(angle),
                ahead + steady.radius * np.sin(angle),
                color=GUIDE_COLOUR,
                linestyle="--",
                linewidth=1.0,
            )
        name = "steady radius" if steady.settled else "not steady:\nradius at the end"
        axes.annotate(
            f"{name}\n{readable(steady.radius)} m",
            (sign * aside, ahead),
            ha="center",
            va="center",
            color="#555555",
        )
    if result.advance is None or result.transfer is None or result.tactical_diameter is None:
        return
    gap = GAP * result.tactical_diameter
    highest, lowest = (float(extreme(_ahead(result))) for extreme in (np.max, np.min))
    beside, above, below = -sign * gap, highest + gap, lowest - gap
    _extend(
        axes,
        [(0.0, 0.0), (beside, 0.0)],
        [(sign * result.transfer, result.advance), (beside, result.advance)],
    )
    text = f"advance {readable(result.advance)} m"
    measure(axes, (beside, 0.0), (beside, result.advance), text, rotation=90, xytext=(-10 * sign, 0))
    x = sign * result.transfer
    _extend(axes, [(x, result.advance), (x, above)], [(0.0, 0.0), (0.0, above)])
    measure(axes, (0.0, above), (x, above), f"transfer {readable(result.transfer)} m", xytext=(0, 11))
    x, y = (
        sign * result.tactical_diameter,
        float(np.interp(result.time_180 or 0.0, result.series.time, _ahead(result))),
    )
    _extend(axes, [(x, y), (x, below)], [(0.0, 0.0), (0.0, below)])
    text = f"tactical diameter {readable(result.tactical_diameter)} m"
    measure(axes, (0.0, below), (x, below), text, xytext=(0, -11))


def _ahead(result: TurningCircle) -> Array:
    """Return how far ahead it was since the helm was put over [m]."""
    series = result.series
    return np.where(series.time >= 0.0, series.along_and_across()[:, 0], 0.0)


def _extend(axes: Any, *lines: list[tuple[float, float]]) -> None:
    """Draw thin lines from the track to where it is measured."""
    for line in lines:
        axes.plot(*zip(*line, strict=True), color=MARK_COLOUR, linewidth=0.7, linestyle=":")


def _draw_rates(panels: list[Any], result: TurningCircle) -> None:
    series = result.series
    rate, speed, angles = panels
    rate.plot(series.time, np.degrees(series.velocity_body[:, 5]), color=HEADING_COLOUR, linewidth=1.5)
    over_time(rate, "yaw rate r [deg/s]")
    helm = rate.twinx()
    draw_helm(helm, series)
    helm.set_ylabel("helm [%]", color=HELM_COLOUR)
    helm.grid(visible=False)
    helm.set_ylim(-110.0, 110.0)
    speed.plot(series.time, series.speed, color=SPEED_COLOUR, linewidth=1.5)
    over_time(speed, "speed [m/s]")
    speed.set_ylim(bottom=0.0)
    angles.plot(
        *broken_at_jumps(series.time, np.degrees(series.drift_angle), turn=360.0),
        color=PURPLE,
        linewidth=1.5,
        label="drift, bow to starboard",
    )
    angles.plot(
        series.time,
        np.degrees(series.euler[:, 0]),
        color=MARK_COLOUR,
        linewidth=1.5,
        linestyle="--",
        label="roll, starboard down",
    )
    over_time(angles, "angle [deg]")
    angles.set_xlabel("time since helm [s]")
    angles.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, **LEGEND)
