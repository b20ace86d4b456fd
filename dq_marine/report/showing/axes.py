"""Figures by matplotlib, without a display, and what several of them need."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dq_marine.report.presentation import Drawing
from dq_marine.util.extras import extra_needed
from dq_marine.util.plot_style import SETTINGS, style_of

with extra_needed("the report", "report"):
    from matplotlib import rc_context
    from matplotlib.lines import Line2D

FALLBACK_FONTS = "'DejaVu Sans', Verdana, 'Segoe UI', sans-serif"
GUIDE_COLOUR = "#999999"


def rendered(drawing: Drawing) -> tuple[str, bytes]:
    """Return a drawing as SVG, to stand in a page, and as PNG; the same each time, for the same numbers."""
    settings: Any = {**SETTINGS, "svg.hashsalt": drawing.name}
    with rc_context(settings):
        figure = drawing.draw()
        vector, pixels = io.StringIO(), io.BytesIO()
        figure.savefig(pixels, format="png", dpi=110, metadata={"Software": None})
        figure.set_layout_engine("none")  # it is laid out; once more would take as long again
        figure.savefig(vector, format="svg", metadata={"Date": None, "Creator": None})
    return for_page(vector.getvalue(), drawing.name), pixels.getvalue()


def for_page(svg: str, name: str) -> str:
    """Return an SVG without its file header, with names of its own and with fonts that every reader has."""
    body = svg[svg.index("<svg") :]
    body = re.sub(r"<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    body = re.sub(r'\bid="', f'id="{name}-', body)
    body = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", body)
    return body.replace("'DejaVu Sans'", FALLBACK_FONTS)


def make_logarithmic(axes: Any) -> None:
    """Give both axes a logarithm, with ticks at powers of ten alone: there are many decades."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.minorticks_off()


def add_legend(figure: Any, names: Iterable[str], titles: dict[str, str], columns: int) -> None:
    """Put one legend for all panels below them."""
    handles = [Line2D([], [], **style_of(name).arguments(), label=titles.get(name, name)) for name in names]
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, handlelength=3.4)


def add_slope_guides(axes: Any, slopes: Sequence[int]) -> None:
    """Draw lines error ~ x^-slope through the lower left of log-log axes, each with its slope beside it."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for slope in slopes:
        start, top = left * (right / left) ** 0.03, low * (high / low) ** 0.42
        reach = (top / low) ** (1.0 / slope)
        x = np.array([start, start * reach])
        axes.plot(x, top * (x / start) ** -slope, color=GUIDE_COLOUR, linewidth=0.9, zorder=0.5)
        number = axes.annotate(
            f"{slope}",
            (start * reach**0.62, top * reach ** (-slope * 0.62)),
            color="#666666",
            fontsize=8.0,
            ha="center",
            va="center",
            bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "edgecolor": "none"},
            annotation_clip=True,
        )
        number.set_in_layout(False)
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)


def drawable(values: ArrayLike, smallest: float) -> Any:
    """Return values as a logarithmic axis can show them: none below the smallest."""
    return np.maximum(np.asarray(values, dtype=float), smallest)
