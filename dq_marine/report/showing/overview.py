"""One figure over all cases: how this package compares with RK4, by the error that is wanted."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.report.names import case_title, title_of
from dq_marine.report.showing.axes import make_logarithmic
from dq_marine.report.showing.curves import BASELINE, Curve, best_own
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import BLACK, BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION

TARGETS = np.geomspace(1e-1, 1e-9, 33)
COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY)
MARKERS = ("o", "s", "^", "D")
DASHES = ("-", "--", ":")


def draw_overview(all_curves: dict[str, dict[str, Curve]]) -> Any:
    """Return the figure: a line a case, over attitude error and over position error."""
    figure = new_figure(12.0, 4.6)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, quantity in zip(panels, ("attitude", "position"), strict=True):
        make_logarithmic(axes)
        for index, (case, curves) in enumerate(all_curves.items()):
            draw_case(axes, curves, quantity, index, case_title(case))
        axes.axhline(1.0, color=INK, linewidth=1.0)
        axes.set_xlim(TARGETS[0], TARGETS[-1])
        axes.set_xlabel(f"{quantity} error wanted [{'rad' if quantity == 'attitude' else 'm'}]")
    panels[0].set_ylabel(f"time of the fastest method over\nthat of {title_of(BASELINE)}")
    panels[0].text(0.02, 0.02, "below 1: this package is faster", transform=panels[0].transAxes, fontsize=8.5)
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, handlelength=3.4
    )
    return figure


def draw_case(axes: Any, curves: dict[str, Curve], quantity: str, index: int, title: str) -> None:
    """Draw the ratio of one case wherever both get there."""
    found = [(target, ratio_at(curves, quantity, float(target))) for target in TARGETS]
    points = [(target, ratio) for target, ratio in found if ratio is not None]
    axes.plot(
        [target for target, _ in points],
        [ratio for _, ratio in points],
        color=COLOURS[index % len(COLOURS)],
        linestyle=DASHES[index // len(COLOURS) % len(DASHES)],
        marker=MARKERS[index % len(MARKERS)],
        markevery=4,
        markersize=4.5,
        linewidth=1.5,
        label=title,
    )


def ratio_at(curves: dict[str, Curve], quantity: str, target: float) -> float | None:
    """Return the time of the fastest own method over that of RK4, None where either does not get there."""
    own = best_own(curves, quantity, target)
    baseline = curves[BASELINE].cost_at(quantity, target) if BASELINE in curves else None
    return None if own is None or baseline is None else own[1] / baseline
