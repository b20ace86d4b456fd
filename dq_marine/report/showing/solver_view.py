"""What the study of the solver shows."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.report.names import title_of
from dq_marine.report.plan import Rows, find
from dq_marine.report.presentation import Check, Drawing, Table
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import BLUE, GREY, ORANGE, VERMILLION

DIRECT, FALLBACKS = "direct", "fallbacks"
MOST_DIRECT = 12
WIDER = (16, 32, 64, 128, 256, 512)
"""Upper edges of the bars beyond what plain Newton may take."""

LOOKS = {DIRECT: (BLUE, "", "plain Newton"), FALLBACKS: (ORANGE, "//", "fallbacks")}


def panels(rows: Rows) -> list[tuple[str, str]]:
    """Return scenes and methods, in order."""
    return list(dict.fromkeys((row["scene"], row["method"]) for row in rows))


def drawings(rows: Rows) -> list[Drawing]:
    """Return a histogram a scene and method."""
    return [
        Drawing(
            "solver",
            "Newton iterations a step",
            "Number of steps, on a logarithmic axis, by the iterations that a step took; those of a fallback count all "
            "that was tried after plain Newton. Refused steps end a motion.",
            lambda: draw(rows),
        )
    ]


def draw(rows: Rows) -> Any:
    """Return the figure."""
    kinds = panels(rows)
    figure = new_figure(4.3 * len(kinds), 3.6)
    grid = figure.subplots(1, len(kinds), sharey=True, squeeze=False)[0]
    for axes, (scene, method) in zip(grid, kinds, strict=True):
        draw_panel(axes, find(rows, scene=scene, method=method))
        axes.set_title(f"{scene}: {title_of(method)}", fontsize=9.5)
    grid[0].set_ylabel("steps")
    labelled = {
        label: bar for axes in grid for bar, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(labelled.values(), labelled.keys(), loc="outside lower center", ncols=len(labelled))
    return figure


def draw_panel(axes: Any, rows: Rows) -> None:
    """Draw one histogram: a bar an iteration, then a bar a doubling, then the refused."""
    edges = [*range(1, MOST_DIRECT + 1), *WIDER]
    bottom = np.zeros(len(edges))
    for how, (colour, hatch, label) in LOOKS.items():
        counts = np.zeros(len(edges))
        for row in find(rows, how=how):
            counts[np.searchsorted(edges, row["iterations"]).clip(max=len(edges) - 1)] += row["steps"]
        if counts.any():
            axes.bar(
                range(len(edges)),
                counts,
                bottom=bottom,
                color=colour,
                hatch=hatch,
                edgecolor="white",
                label=label,
            )
        bottom += counts
    refused = sum(row["steps"] for row in rows if row["how"] not in LOOKS)
    if refused:
        axes.bar(len(edges), refused, color=VERMILLION, hatch="xx", edgecolor="white", label="refused")
    names = [str(edge) if edge <= MOST_DIRECT else f"to {edge}" for edge in edges] + ["refused"]
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=8)
    axes.set_yscale("log")
    axes.set_ylim(0.7, None)
    axes.grid(visible=False, axis="x")
    axes.axvline(MOST_DIRECT - 0.5, color=GREY, linewidth=0.8, linestyle=":")
    axes.set_xlabel("iterations")


def tables(rows: Rows) -> list[Table]:
    """Return means and shares."""
    lines = []
    for scene, method in panels(rows):
        own = find(rows, scene=scene, method=method)
        steps, direct, fallbacks, refused = totals(own)
        mean = sum(row["iterations"] * row["steps"] for row in find(own, how=DIRECT)) / max(direct, 1)
        lines.append(
            [
                f"{scene}: {title_of(method)}",
                f"{steps:,}",
                f"{mean:.2f}",
                f"{fallbacks:,} ({fallbacks / max(steps, 1):.2%})",
                f"{refused:,}",
            ]
        )
    header = ["motions", "steps", "iterations of plain Newton", "fallbacks", "motions refused"]
    return [Table("How steps were solved", header, lines)]


def totals(rows: Rows) -> tuple[int, int, int, int]:
    """Return numbers of steps solved, solved directly, solved by the fallback, and of refusals."""
    direct = sum(row["steps"] for row in find(rows, how=DIRECT))
    fallbacks = sum(row["steps"] for row in find(rows, how=FALLBACKS))
    return direct + fallbacks, direct, fallbacks, sum(row["steps"] for row in rows) - direct - fallbacks


def findings(rows: Rows) -> list[str]:
    """Return how hard ordinary steps are."""
    own = find(rows, scene="ordinary")
    if not own:
        return []
    steps, direct, fallbacks, refused = totals(own)
    mean = sum(row["iterations"] * row["steps"] for row in find(own, how=DIRECT)) / max(direct, 1)
    most = max(row["iterations"] for row in own)
    sentence = (
        f"In {steps:,} steps of the environment under random actions a step takes {mean:.2f} Newton iterations on "
        f"average, {most} at most; {fallbacks} steps took the fallback and {refused} refused."
    )
    return [sentence]


def checks(rows: Rows) -> list[Check]:
    """Return whether ordinary steps are ordinary."""
    own = find(rows, scene="ordinary")
    if not own:
        return []
    steps, _, fallbacks, refused = totals(own)
    return [
        Check(
            "ordinary steps need neither fallback nor refusal",
            f"{fallbacks} fallbacks and {refused} refused of {steps:,}",
            "0",
            steps > 0 and fallbacks == refused == 0,
        )
    ]
