"""Pictures of manoeuvres by matplotlib: figures, files, and what several pictures share."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres.quantities import Result
from dq_marine.manoeuvres.series import Series
from dq_marine.util.extras import extra_needed
from dq_marine.util.figures import RESOLUTION
from dq_marine.util.figures import new_figure as empty_figure
from dq_marine.util.files import with_folder, write_whole
from dq_marine.util.plot_style import BLUE, GREEN, GREY, INK, ORANGE, SETTINGS, SKY, VERMILLION

with extra_needed("drawing a manoeuvre", "report"):
    from matplotlib import rc_context
    from matplotlib.patches import Polygon

Array = NDArray[np.float64]

FORMATS = (".png", ".svg", ".pdf")
TRACK_COLOUR, HELM_COLOUR, HEADING_COLOUR, SPEED_COLOUR = BLUE, ORANGE, BLUE, GREEN
MARK_COLOUR, GUIDE_COLOUR, HULL_COLOUR = VERMILLION, GREY, SKY

HULL = ((0.5, 0.0), (0.28, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.28, -0.5))
"""Outline of a hull, as shares of length and width; bow first."""


def check_picture_path(path: Path) -> None:
    """Refuse a path that no picture can be written to.

    Raises:
        InvalidInputError: its ending is not one of `FORMATS`.
    """
    if path.suffix.lower() not in FORMATS:
        raise InvalidInputError(f"{path} is no picture's name; end it with one of {', '.join(FORMATS)}")


def save_picture(draw: Callable[[], Any], path: Path) -> None:
    """Draw a figure and write it; the path's ending chooses the format, and the same numbers give the same file.

    Raises:
        InvalidInputError: the ending is unknown, or the file cannot be written.
    """
    check_picture_path(path)
    kind = path.suffix.lower().removeprefix(".")
    metadata: dict[str, Any] = {
        "png": {"Software": None},
        "svg": {"Date": None, "Creator": None},
        "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    }[kind]
    settings: Any = {**SETTINGS, "svg.hashsalt": path.stem}
    with rc_context(settings):
        buffer = io.BytesIO()
        draw().savefig(buffer, format=kind, dpi=RESOLUTION, metadata=metadata)
    write_whole(with_folder(path), buffer.getvalue())


def new_figure(result: Result, title: str, width: float = 11.0, height: float = 6.4) -> Any:
    """Return an empty figure with a heading [inches]."""
    figure = empty_figure(width, height)
    figure.suptitle(
        f"{result.vehicle}: {title}", fontsize=13.0, color=INK, fontweight="bold", x=0.01, ha="left"
    )
    return figure


def draw_track(axes: Any, result: Result, most_hulls: int) -> None:
    """Draw the track, the heading at time 0 upwards, with the hull at equal times, at most so often that it is seen."""
    series = result.series
    hulls = min(max(int(float(series.distance[-1]) / result.length), 2), most_hulls)
    ahead, starboard = series.along_and_across().T
    axes.plot(starboard, ahead, color=TRACK_COLOUR, linewidth=1.6, zorder=3)
    for moment in np.linspace(0.0, float(series.time[-1]), hulls):
        axes.add_patch(Polygon(hull_at(series, moment, result), closed=True, **HULL_STYLE))
    axes.plot([0.0], [0.0], "o", color=MARK_COLOUR, markersize=5.0, zorder=5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("to starboard of the approach [m]")
    axes.set_ylabel("ahead [m]")


HULL_STYLE: dict[str, Any] = {
    "facecolor": HULL_COLOUR,
    "alpha": 0.3,
    "edgecolor": TRACK_COLOUR,
    "linewidth": 0.7,
    "zorder": 2,
}


def hull_at(series: Series, moment: float, result: Result) -> Array:
    """Return the hull's outline at a time, as [to starboard, ahead] of the approach [m], shape (5, 2)."""
    track = series.along_and_across()
    ahead, starboard = (np.interp(moment, series.time, column) for column in track.T)
    turned = float(np.interp(moment, series.time, series.heading_change))
    forward, side = np.array(HULL).T * np.array([[result.length], [result.width]])
    cosine, sine = np.cos(turned), np.sin(turned)
    return np.column_stack(
        [starboard + sine * forward + cosine * side, ahead + cosine * forward - sine * side]
    )


def draw_helm(axes: Any, series: Series, label: str = "helm") -> None:
    """Draw the helm as steps, in per cent of full helm."""
    axes.step(series.time, 100.0 * series.helm, where="post", color=HELM_COLOUR, linewidth=1.4, label=label)


def measure(
    axes: Any, start: tuple[float, float], end: tuple[float, float], text: str, **options: Any
) -> None:
    """Draw a dimension line between two points, with a text at its middle."""
    axes.annotate(
        "",
        end,
        xytext=start,
        arrowprops={
            "arrowstyle": "<->",
            "color": MARK_COLOUR,
            "linewidth": 1.2,
            "shrinkA": 0.0,
            "shrinkB": 0.0,
        },
        zorder=6,
    )
    middle = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    settings = {"ha": "center", "va": "center", "xytext": (0, 0)} | options
    axes.annotate(text, middle, textcoords="offset points", color=MARK_COLOUR, zorder=7, bbox=BOX, **settings)


BOX: dict[str, Any] = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
"""Behind texts that stand on lines."""


LEGEND: dict[str, Any] = {"frameon": True, "facecolor": "white", "edgecolor": "none", "framealpha": 0.85}
"""Style of a legend that covers lines."""


def over_time(axes: Any, label: str) -> None:
    """Label axes whose abscissa is time, and mark time 0."""
    axes.set_ylabel(label)
    axes.axvline(0.0, color=GUIDE_COLOUR, linewidth=0.8, linestyle=":")
    axes.margins(x=0.01)
