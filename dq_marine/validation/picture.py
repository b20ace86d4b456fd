"""The picture of a comparison: how far each number is off, beside how far it may be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dq_marine.util.extras import extra_needed
from dq_marine.util.figures import new_figure, save_figure
from dq_marine.util.plot_style import GREEN, GREY, INK, ORANGE, SETTINGS, VERMILLION
from dq_marine.validation.comparison import Comparison, Line, Verdict

with extra_needed("drawing a comparison", "report"):
    from matplotlib import rc_context

FURTHEST = 3.0
"""Offset at which points are drawn that are further off."""

COLOURS = {Verdict.AGREES: GREEN, Verdict.EXPLAINED: ORANGE, Verdict.DIFFERS: VERMILLION}
MARKERS = {Verdict.AGREES: "o", Verdict.EXPLAINED: "D", Verdict.DIFFERS: "X"}


def save_offsets(comparison: Comparison, path: Path) -> None:
    """Write the picture; the path's ending chooses the format.

    Raises:
        InvalidInputError: the path cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    settings: Any = SETTINGS
    with rc_context(settings):
        figure = new_figure(9.0, 1.4 + 0.3 * len(comparison.lines))
        _draw(figure.add_subplot(), comparison)
        save_figure(figure, path)


def _draw(axes: Any, comparison: Comparison) -> None:
    axes.axvspan(-1.0, 1.0, color=GREY, alpha=0.15, linewidth=0.0)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    shown: set[Verdict] = set()
    for place, line in enumerate(comparison.lines):
        verdict = line.verdict
        axes.plot(
            [_place(line)],
            [place],
            MARKERS[verdict],
            color=COLOURS[verdict],
            markersize=7.0,
            label=None if verdict in shown else verdict.value,
        )
        shown.add(verdict)
    axes.set_yticks(range(len(comparison.lines)), [_label(line) for line in comparison.lines])
    axes.set_ylim(len(comparison.lines) - 0.5, -0.5)
    axes.set_xlim(-FURTHEST - 0.2, FURTHEST + 0.2)
    axes.set_xlabel("difference over the largest that agrees; bounds are at -1 and 1")
    axes.set_title(f"{comparison.title}: what is simulated beside its references", loc="left")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _place(line: Line) -> float:
    offset = line.offset
    return FURTHEST if offset is None else min(max(offset, -FURTHEST), FURTHEST)


def _label(line: Line) -> str:
    return f"{line.trial}: {line.quantity.label}"
