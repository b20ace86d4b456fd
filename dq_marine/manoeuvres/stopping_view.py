"""The picture of a stopping test."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.manoeuvres.canvas import (
    HEADING_COLOUR,
    HELM_COLOUR,
    MARK_COLOUR,
    SPEED_COLOUR,
    draw_track,
    measure,
    new_figure,
    over_time,
)
from dq_marine.manoeuvres.stopping import Stopping
from dq_marine.util.readable import readable

HULLS = 6
SHOWN_APPROACH = 0.25
"""Largest part of the approach that is shown, over the time to stop."""

ORDERS = {"astern": "full astern", "off": "thrust off"}


def draw(result: Stopping) -> Any:
    """Return the figure: the track with its reach, speed and throttle, and the heading."""
    figure = new_figure(result, f"stopping, {ORDERS[str(result.settings['order'])]}")
    grid = figure.add_gridspec(2, 2, width_ratios=[1.0, 1.5])
    track = figure.add_subplot(grid[:, 0])
    draw_track(track, result, HULLS)
    if result.head_reach is not None and result.track_reach is not None:
        side = -0.8 * result.width
        for reach in (0.0, result.head_reach):
            track.plot([0.0, side], [reach, reach], color=MARK_COLOUR, linewidth=0.7, linestyle=":")
        text = f"head reach {readable(result.head_reach)} m\ntrack reach {readable(result.track_reach)} m"
        measure(
            track,
            (side, 0.0),
            (side, result.head_reach),
            text,
            ha="right",
            xytext=(-8, 0),
            multialignment="right",
        )
    speed = figure.add_subplot(grid[0, 1])
    heading = figure.add_subplot(grid[1, 1], sharex=speed)
    series = result.series
    speed.plot(series.time, series.velocity_body[:, 0], color=SPEED_COLOUR, linewidth=1.8)
    over_time(speed, "speed ahead u [m/s]")
    if result.stopping_time is not None:
        value = float(np.interp(result.stopping_time, series.time, series.velocity_body[:, 0]))
        speed.plot([result.stopping_time], [value], "o", color=MARK_COLOUR, markersize=5.5)
        speed.annotate(
            f"after {readable(result.stopping_time)} s",
            (0.98, 0.9),
            xycoords="axes fraction",
            ha="right",
            color=MARK_COLOUR,
        )
    throttle = speed.twinx()
    throttle.step(series.time, 100.0 * series.throttle, where="post", color=HELM_COLOUR, linewidth=1.3)
    throttle.set_ylabel("throttle [%]", color=HELM_COLOUR)
    throttle.set_ylim(-110.0, 110.0)
    throttle.grid(visible=False)
    heading.plot(series.time, np.degrees(series.heading_change), color=HEADING_COLOUR, linewidth=1.5)
    over_time(heading, "heading change [deg]")
    heading.set_xlabel("time since the order [s]")
    end = float(series.time[-1])
    heading.set_xlim(max(float(series.time[0]), -SHOWN_APPROACH * end), 1.02 * end)
    reach = max(1.1 * float(np.abs(np.degrees(series.heading_change)).max()), 1.0)
    heading.set_ylim(-reach, reach)
    return figure
