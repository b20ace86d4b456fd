"""Figures by matplotlib as files: made without a display, written whole. matplotlib is imported when one is made."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed
from dq_marine.util.files import replacing_file
from dq_marine.util.plot_style import GRID, INK

RESOLUTION = 150
"""Of a picture made of pixels [dots per inch]."""


def new_figure(width: float, height: float) -> Any:
    """Return an empty figure [inches].

    Raises:
        MissingDependencyError: matplotlib is not installed.
    """
    with extra_needed("drawing", "report"):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)  # draws without a display
    return figure


def check_picture_path(path: Path, *, extra: str = "report") -> None:
    """Check that a picture can be written to a path.

    Args:
        path: of the picture.
        extra: that brings matplotlib to who asks.

    Raises:
        InvalidInputError: matplotlib does not know its ending.
        MissingDependencyError: matplotlib is not installed.
    """
    with extra_needed("plotting", extra):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
    known = FigureCanvasAgg.get_supported_filetypes()
    if path.suffix.removeprefix(".") not in known:
        raise InvalidInputError(
            f"{path} has no ending that pictures have; give one of {', '.join(sorted(known))}"
        )


def save_figure(figure: Any, path: Path) -> None:
    """Write a figure; the path's ending chooses the format (.png, .svg, .pdf).

    Raises:
        InvalidInputError: the path cannot be written.
    """
    with replacing_file(path) as temporary:
        figure.savefig(temporary, dpi=RESOLUTION)


def keep_what_carries_data(axes: Any) -> None:
    """Leave out the frame's upper and right side, and put a light grid behind the curves."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=INK)
