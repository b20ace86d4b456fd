"""The picture of an acceleration from rest."""

from __future__ import annotations

from typing import Any

from dq_marine.manoeuvres.acceleration import TIME_CONSTANT_SHARE, Acceleration
from dq_marine.manoeuvres.canvas import (
    GUIDE_COLOUR,
    MARK_COLOUR,
    SPEED_COLOUR,
    TRACK_COLOUR,
    new_figure,
    over_time,
)
from dq_marine.util.readable import readable


def draw(result: Acceleration) -> Any:
    """Return the figure: speed and way against time."""
    figure = new_figure(
        result,
        f"acceleration from rest, throttle {100.0 * float(result.settings['throttle']):g} %",
        height=5.6,
    )
    speed, way = figure.subplots(2, 1, sharex=True, height_ratios=[1.6, 1.0])
    series = result.series
    speed.plot(series.time, series.velocity_body[:, 0], color=SPEED_COLOUR, linewidth=1.8)
    speed.axhline(result.top_speed, color=GUIDE_COLOUR, linestyle="--", linewidth=0.9)
    speed.annotate(
        f"{result.speed_name} {readable(result.top_speed)} m/s",
        (float(series.time[-1]), result.top_speed),
        xytext=(0, -4),
        textcoords="offset points",
        ha="right",
        va="top",
    )
    for share, moment in ((TIME_CONSTANT_SHARE, result.time_63), (0.9, result.time_90)):
        if moment is None:
            continue
        speed.plot([moment], [share * result.top_speed], "o", color=MARK_COLOUR, markersize=5.5, zorder=4)
        speed.annotate(
            f"{100.0 * share:.0f} % after {readable(moment)} s",
            (moment, share * result.top_speed),
            xytext=(9, -3),
            textcoords="offset points",
            color=MARK_COLOUR,
            va="top",
        )
    over_time(speed, "speed ahead u [m/s]")
    speed.set_ylim(bottom=min(0.0, float(series.velocity_body[:, 0].min())))
    way.plot(series.time, series.distance, color=TRACK_COLOUR, linewidth=1.6)
    over_time(way, "way [m]")
    way.set_xlabel("time [s]")
    return figure
