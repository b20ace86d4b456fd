"""The picture of a zig-zag test."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dq_marine.manoeuvres.canvas import (
    BOX,
    GUIDE_COLOUR,
    HEADING_COLOUR,
    HELM_COLOUR,
    MARK_COLOUR,
    draw_helm,
    draw_track,
    new_figure,
    over_time,
)
from dq_marine.manoeuvres.zig_zag import Swing, ZigZag

HULLS = 14


def draw(result: ZigZag) -> Any:
    """Return the figure: heading and helm against time with the overshoots, and the track."""
    angle = math.degrees(result.angle)
    figure = new_figure(result, f"zig-zag {angle:g} deg, helm {100.0 * float(result.settings['helm']):.3g} %")
    upper, lower = figure.subplots(2, 1, height_ratios=[2.0, 1.0])
    _draw_heading(upper, result, angle)
    draw_track(lower, result, HULLS)
    _lay_ahead_to_the_right(lower, result)
    return figure


def _draw_heading(axes: Any, result: ZigZag, angle: float) -> None:
    series = result.series
    (heading,) = axes.plot(
        series.time,
        np.degrees(series.heading_change),
        color=HEADING_COLOUR,
        linewidth=1.7,
        label="heading change",
    )
    for side in (angle, -angle):
        axes.axhline(side, color=GUIDE_COLOUR, linewidth=0.8, linestyle="--")
    over_time(axes, "heading change [deg]")
    axes.set_xlabel("time since the first helm [s]")
    for number, swing in enumerate(result.swings):
        _draw_overshoot(axes, number + 1, swing, angle)
    helm = axes.twinx()
    draw_helm(helm, series)
    helm.set_ylabel("helm [%]", color=HELM_COLOUR)
    helm.grid(visible=False)
    helm.set_ylim(-110.0, 110.0)
    reach = 1.25 * max(float(np.abs(np.degrees(series.heading_change)).max()), 1.2 * angle)
    axes.set_ylim(-reach, reach)
    axes.legend([heading, helm.lines[0]], ["heading change", "helm"], loc="upper right", ncols=2)


def _draw_overshoot(axes: Any, number: int, swing: Swing, angle: float) -> None:
    if swing.overshoot is None or swing.peak_time is None:
        return
    peak = swing.side * (angle + math.degrees(swing.overshoot))
    axes.plot([swing.peak_time] * 2, [swing.side * angle, peak], color=MARK_COLOUR, linewidth=1.6)
    axes.annotate(
        f"{number}: {math.degrees(swing.overshoot):.3g} deg",
        (swing.peak_time, peak),
        xytext=(0, 8 * swing.side),
        textcoords="offset points",
        ha="center",
        va="bottom" if swing.side > 0.0 else "top",
        color=MARK_COLOUR,
        bbox=BOX,
    )


def _lay_ahead_to_the_right(axes: Any, result: ZigZag) -> None:
    """Turn the track by a quarter: a zig-zag is long and narrow."""
    for line in axes.lines:
        line.set_data(line.get_ydata(), line.get_xdata())
    for patch in axes.patches:
        patch.set_xy(patch.get_xy()[:, ::-1])
    axes.set_xlabel("ahead [m]")
    axes.set_ylabel("to starboard [m]")
    axes.relim()
    axes.autoscale_view()
    axes.invert_yaxis()
