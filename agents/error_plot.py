"""A picture of a flight: errors and actions against time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.agents.atomic import replacing_file
from dq_marine.agents.episodes import SETTLED_ATTITUDE, SETTLED_POSITION, Array, Episode
from dq_marine.errors import InvalidInputError
from dq_marine.extras import extra_needed

with extra_needed("plotting", "agents"):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7")
"""Okabe and Ito's palette, told apart with every common colour vision; in the order of the axes."""

INK = "#333333"
THRESHOLD_COLOUR = "#888888"

SMALLEST_POSITION = 1e-3
"""Where the axis of the position error ends [m]: nobody steers to less than a millimetre."""

SMALLEST_ATTITUDE_DEG = 1e-2
"""Where the axis of the attitude error ends [degrees]."""


def save_plot(episode: Episode, path: Path, *, axis_names: Sequence[str], title: str) -> None:
    """Draw position error, attitude error and actions over time into a picture file.

    Args:
        episode: what was flown.
        path: of the picture; its ending chooses the format (.png, .svg, .pdf).
        axis_names: of the actions, in their order.
        title: above the picture.

    Raises:
        InvalidInputError: the path cannot be written, or matplotlib does not know its ending.
    """
    check_picture_path(path)
    figure = Figure(figsize=(8.0, 7.0), layout="constrained")
    FigureCanvasAgg(figure)  # draws without a display
    errors, attitudes, actions = figure.subplots(3, 1, sharex=True)
    figure.suptitle(title, color=INK)
    _draw_error(errors, episode.time, episode.position_error, SETTLED_POSITION, SMALLEST_POSITION)
    attitude_deg = np.degrees(episode.attitude_error)
    _draw_error(attitudes, episode.time, attitude_deg, math.degrees(SETTLED_ATTITUDE), SMALLEST_ATTITUDE_DEG)
    errors.set_ylabel("position error [m]")
    attitudes.set_ylabel("attitude error [deg]")
    _draw_actions(actions, episode, axis_names)
    actions.set_xlabel("time [s]")
    if len(episode.actions):  # an interrupted flight may have none
        actions.set_xlim(0.0, float(episode.time[-1]))
    with replacing_file(path) as temporary:
        figure.savefig(temporary, dpi=150)


def check_picture_path(path: Path) -> None:
    """Check that a picture can be written to a path.

    Raises:
        InvalidInputError: matplotlib does not know its ending.
    """
    known = FigureCanvasAgg.get_supported_filetypes()
    if path.suffix.removeprefix(".") not in known:
        raise InvalidInputError(
            f"{path} has no ending that pictures have; give one of {', '.join(sorted(known))}"
        )


def _draw_error(axes: Any, time: Array, error: Array, threshold: float, smallest: float) -> None:
    """Draw an error on a logarithmic axis, where centimetres show beside metres."""
    drawable = np.maximum(error, 0.1 * smallest)  # below the axis: a logarithm has no zero
    axes.semilogy(time, drawable, color=COLOURS[0], linewidth=1.8)
    axes.set_ylim(smallest, 2.0 * max(float(error.max()), threshold))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.axhline(threshold, color=THRESHOLD_COLOUR, linestyle="--", linewidth=1.0)
    axes.annotate(
        f"settled: {threshold:g}",
        (1.0, threshold),
        xycoords=("axes fraction", "data"),
        xytext=(-4, 3),
        textcoords="offset points",
        ha="right",
        color=THRESHOLD_COLOUR,
        fontsize=9,
    )
    _tidy(axes)


def _draw_actions(axes: Any, episode: Episode, axis_names: Sequence[str]) -> None:
    """Draw each action as it was held, from instant to instant."""
    for index, name in enumerate(axis_names):
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
    _tidy(axes)


def _tidy(axes: Any) -> None:
    """Keep what carries data, drop the rest."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=INK)
