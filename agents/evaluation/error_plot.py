"""A picture of a flight: the task's metrics and the actions against time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.metrics import Array, Metric
from dq_marine.util.angle_lines import broken_at_jumps
from dq_marine.util.figures import check_picture_path, keep_what_carries_data, new_figure, save_figure
from dq_marine.util.plot_style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION

COLOURS = (BLUE, ORANGE, GREEN, VERMILLION, SKY, PURPLE)
"""In the order of the axes."""

SMALLEST = 0.01
"""Where the axis of an error ends, over its tolerance: nobody steers closer."""


def save_plot(episode: Episode, path: Path, *, title: str) -> None:
    """Draw metrics and actions over time into a picture file.

    Args:
        episode: what was flown.
        path: of the picture; its ending chooses the format (.png, .svg, .pdf).
        title: above the picture.

    Raises:
        InvalidInputError: the path cannot be written, or matplotlib does not know its ending.
        MissingDependencyError: matplotlib is not installed.
    """
    check_picture_path(path)
    panels = len(episode.metrics) + 1
    figure = new_figure(8.0, 1.0 + 2.0 * panels)
    *charts, actions = figure.subplots(panels, 1, sharex=True, squeeze=False)[:, 0]
    figure.suptitle(title, color=INK)
    for axes, metric in zip(charts, episode.metrics, strict=True):
        _draw_metric(axes, episode.time, metric, metric.shown(episode.measured[metric.name]))
    _draw_actions(actions, episode)
    actions.set_xlabel("time [s]")
    if len(episode.actions):  # an interrupted flight may have none
        actions.set_xlim(0.0, float(episode.time[-1]))
    save_figure(figure, path)


def _draw_metric(axes: Any, time: Array, metric: Metric, values: Array) -> None:
    """Draw a metric; one with a tolerance on a logarithmic axis, where centimetres show beside metres."""
    axes.set_ylabel(metric.heading())
    keep_what_carries_data(axes)
    if metric.tolerance is None:
        line = broken_at_jumps(time, values, turn=360.0) if metric.unit == "rad" else (time, values)
        axes.plot(*line, color=COLOURS[0], linewidth=1.8)
        return
    tolerance = float(metric.shown(metric.tolerance))
    error, smallest = np.abs(values), SMALLEST * tolerance
    drawable = np.maximum(error, 0.1 * smallest)  # below the axis: a logarithm has no zero
    axes.semilogy(time, drawable, color=COLOURS[0], linewidth=1.8)
    axes.set_ylim(smallest, 2.0 * max(float(error.max()), tolerance))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.axhline(tolerance, color=GREY, linestyle="--", linewidth=1.0)
    axes.annotate(
        f"settled: {tolerance:g} {metric.shown_unit}".rstrip(),
        (1.0, tolerance),
        xycoords=("axes fraction", "data"),
        xytext=(-4, 3),
        textcoords="offset points",
        ha="right",
        color=GREY,
        fontsize=9,
    )


def _draw_actions(axes: Any, episode: Episode) -> None:
    """Draw each action as it was held, from instant to instant."""
    for index, name in enumerate(episode.action_names):
        axes.stairs(
            episode.actions[:, index],
            episode.time,
            baseline=None,
            color=COLOURS[index % len(COLOURS)],
            linewidth=1.3,
            label=name,
        )
    axes.set_ylim(-1.08, 1.08)
    axes.set_ylabel("action [share of limit]")
    axes.legend(ncols=6, loc="upper center", bbox_to_anchor=(0.5, 1.16), fontsize=9, frameon=False)
    keep_what_carries_data(axes)
