"""The picture of a spiral test."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dq_marine.manoeuvres.canvas import (
    GUIDE_COLOUR,
    HEADING_COLOUR,
    HELM_COLOUR,
    MARK_COLOUR,
    draw_helm,
    new_figure,
    over_time,
)
from dq_marine.manoeuvres.spiral import SMALLEST_LOOP, Spiral, SpiralPoint


def draw(result: Spiral) -> Any:
    """Return the figure: yaw rate against helm on both branches, and both against time."""
    figure = new_figure(result, "direct spiral (Dieudonné)")
    branches, time = figure.subplots(1, 2, width_ratios=[1.2, 1.0])
    for line in (branches.axhline, branches.axvline):
        line(0.0, color=GUIDE_COLOUR, linewidth=0.8)
    _draw_branch(branches, result.to_port, "helm going to port", HEADING_COLOUR, "o", "-")
    _draw_branch(branches, result.to_starboard, "helm going back to starboard", MARK_COLOUR, "s", "--")
    branches.set_xlabel("helm [% of full helm], positive to starboard")
    branches.set_ylabel("steady yaw rate r [deg/s]")
    branches.set_title(_verdict(result), loc="left")
    branches.legend(loc="upper left")
    series = result.series
    time.plot(series.time, np.degrees(series.velocity_body[:, 5]), color=HEADING_COLOUR, linewidth=1.2)
    over_time(time, "yaw rate r [deg/s]")
    time.set_xlabel("time [s]")
    helm = time.twinx()
    draw_helm(helm, series)
    helm.set_ylabel("helm [%]", color=HELM_COLOUR)
    helm.grid(visible=False)
    return figure


def _draw_branch(
    axes: Any, points: tuple[SpiralPoint, ...], label: str, colour: str, marker: str, dash: str
) -> None:
    helm = [100.0 * point.helm for point in points]
    rate = [math.degrees(point.yaw_rate) for point in points]
    axes.plot(
        helm, rate, color=colour, marker=marker, linestyle=dash, markersize=5.0, linewidth=1.4, label=label
    )
    time_varying = [(x, y) for x, y, point in zip(helm, rate, points, strict=True) if not point.settled]
    if time_varying:
        axes.plot(
            *zip(*time_varying, strict=True), "o", color="white", markeredgecolor=colour, markersize=5.0
        )


def _verdict(result: Spiral) -> str:
    if result.loop_width is None:
        return "the loop is wider than the helm: unstable on course"
    if result.loop_width <= SMALLEST_LOOP:
        return "no loop: stable on course"
    return f"loop of {100.0 * result.loop_width:.3g} % of full helm: unstable on course"
