"""What the study of extremes shows."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.report.names import OWN, in_order, title_of
from dq_marine.report.plan import Rows, distinct, find
from dq_marine.report.presentation import Check, Drawing, Table, number
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import BLUE, GREY, INK, ORANGE, SKY, VERMILLION

ACCURATE, BOUNDED, WRONG, REFUSED, FAILED = (
    "accurate",
    "bounded",
    "wrong in silence",
    "refused",
    "blew up",
)
OUTCOMES = {
    ACCURATE: (BLUE, ""),
    BOUNDED: (SKY, ".."),
    REFUSED: (GREY, ""),
    WRONG: (ORANGE, "xx"),
    FAILED: (VERMILLION, "//"),
}
"""Colour and hatching of each outcome, from good to bad."""

FACTORS = {
    "spin": "spin [rad/s]",
    "speed": "speed [m/s]",
    "mass": "mass [kg]",
    "condition": "condition of M",
    "step": "step [s]",
    "distance": "distance [m]",
}


def drawings(rows: Rows) -> list[Drawing]:
    """Return the shares of the outcomes, and where they are usable."""
    return [
        Drawing(
            "extreme-outcomes",
            "What becomes of extreme motions",
            "Number of motions by outcome. Refused motions are left as they were; those blown up or wrong in silence "
            "are lost.",
            lambda: draw_outcomes(rows),
        ),
        Drawing(
            "extreme-usable",
            "Share of extreme motions that end accurate or bounded, by level of what is varied",
            "In percent, over all motions that share the level.",
            lambda: draw_usable(rows),
        ),
    ]


def draw_outcomes(rows: Rows) -> Any:
    """Return the bars."""
    names = in_order(set(distinct(rows, "method")))
    figure = new_figure(10.5, 1.3 + 0.34 * len(names))
    axes = figure.subplots()
    left = np.zeros(len(names))
    for outcome, (colour, hatch) in OUTCOMES.items():
        counts = np.array([len(find(rows, method=name, outcome=outcome)) for name in names])
        bars = axes.barh(
            [title_of(name) for name in names],
            counts,
            left=left,
            color=colour,
            edgecolor="white",
            hatch=hatch,
            label=outcome,
            height=0.75,
        )
        axes.bar_label(
            bars,
            [str(count) if count else "" for count in counts],
            label_type="center",
            fontsize=8.5,
            bbox=BOX,
        )
        left += counts
    axes.invert_yaxis()
    axes.set_xlim(0, left.max())
    axes.set_xlabel("motions")
    axes.grid(visible=False, axis="y")
    figure.legend(loc="outside upper center", ncols=len(OUTCOMES))
    return figure


BOX = {"boxstyle": "round,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.75}


def draw_usable(rows: Rows) -> Any:
    """Return the shares as a table of shades."""
    names = in_order(set(distinct(rows, "method")))
    columns = [(factor, level) for factor in FACTORS for level in sorted(set(distinct(rows, factor)))]
    shares = np.array(
        [
            [usable_share(find(rows, method=name, **{factor: level})) for factor, level in columns]
            for name in names
        ]
    )
    figure = new_figure(2.6 + 0.5 * len(columns), 1.5 + 0.34 * len(names))
    axes = figure.subplots()
    axes.pcolormesh(shares, cmap="Blues", vmin=0.0, vmax=1.3)
    axes.invert_yaxis()
    for (line, column), share in np.ndenumerate(shares):
        axes.text(
            column + 0.5, line + 0.5, f"{100 * share:.0f}", ha="center", va="center", fontsize=8.5, color=INK
        )
    axes.set_yticks(np.arange(len(names)) + 0.5, [title_of(name) for name in names])
    axes.set_xticks(np.arange(len(columns)) + 0.5, [f"{level:g}" for _, level in columns], fontsize=8.5)
    axes.grid(visible=False)
    mark_factors(axes, [factor for factor, _ in columns])
    return figure


def mark_factors(axes: Any, factors: list[str]) -> None:
    """Name the groups of columns above them, and part them."""
    for factor in dict.fromkeys(factors):
        first, count = factors.index(factor), factors.count(factor)
        axes.text(first + 0.5 * count, -0.25, FACTORS[factor], ha="center", va="bottom", fontsize=8.5)
        if first:
            axes.axvline(first, color="white", linewidth=4)


def usable_share(rows: Rows) -> float:
    """Return the share of motions that end accurate or bounded."""
    return sum(row["outcome"] in (ACCURATE, BOUNDED) for row in rows) / max(len(rows), 1)


def tables(rows: Rows) -> list[Table]:
    """Return counts of outcomes, and what looking for other branches found."""
    lines = []
    for name in in_order(set(distinct(rows, "method"))):
        own = find(rows, method=name)
        counts = [str(len(find(own, outcome=outcome))) for outcome in OUTCOMES]
        reasons = ", ".join(sorted({row["reason"] for row in own if row["reason"]})).replace("_", " ")
        lines.append([title_of(name), *counts, reasons])
    known = len({row["cell"] for row in rows if row["has_reference"]})
    total = len(set(distinct(rows, "cell")))
    found = [
        Table(
            f"Outcomes of {total:,} motions",
            ["method", *OUTCOMES, "reasons of refusals"],
            lines,
            f"The exact motion is known for {known:,} of {total:,}: of the others nothing can count as accurate.",
        )
    ]
    checked = [row for row in rows if "branch_steps" in row]
    return [*found, branch_table(checked)] if checked else found


def branch_table(rows: Rows) -> Table:
    """Return how many steps were looked at, and how many solutions are not the one connected to rest."""
    lines = []
    for name in distinct(rows, "method"):
        own = find(rows, method=name)
        lines.append([title_of(name), *(f"{total(own, field):,}" for field in BRANCHES)])
    return Table(
        "Solutions walked to from rest",
        ["method", *BRANCHES.values()],
        lines,
        "A step counts as agreeing if walking from rest leads to the same attitude to 1e-6, for the whole step or in "
        "equal pieces.",
    )


BRANCHES = {
    "branch_steps": "steps looked at",
    "branch_whole": "agree",
    "branch_split": "agree in pieces",
    "branch_other": "on another branch",
}


def total(rows: Rows, field: str) -> int:
    """Return the sum of an entry."""
    return sum(row[field] for row in rows)


def findings(rows: Rows) -> list[str]:
    """Return who fails how."""
    sentences = [gist(rows)]
    for name in in_order(set(distinct(rows, "method"))):
        own = find(rows, method=name)
        counts = {outcome: len(find(own, outcome=outcome)) for outcome in OUTCOMES}
        lost = counts[WRONG] + counts[FAILED]
        sentences.append(
            f"{title_of(name)}: {counts[ACCURATE]} accurate, {counts[BOUNDED]} bounded, {counts[REFUSED]} refused by "
            f"name, {lost} lost ({counts[FAILED]} blown up, {counts[WRONG]} wrong in silence)."
        )
    wrong = [row for row in rows if row["outcome"] == WRONG and row["method"] in OWN]
    if wrong:
        least = min(row["fallbacks"] / row["steps"] for row in wrong)
        sentences.append(
            f"Where a method of this package is wrong in silence, it needed the fallback for at least {least:.1f} "
            "solves a step: `fallback_steps` tells that a step is far too large."
        )
    return sentences


def gist(rows: Rows) -> str:
    """Return how many motions each method loses."""
    parts = []
    for name in in_order(set(distinct(rows, "method"))):
        lost = len(find(rows, method=name, outcome=WRONG)) + len(find(rows, method=name, outcome=FAILED))
        parts.append(f"{title_of(name)}: {lost}")
    total = len(set(distinct(rows, "cell")))
    return f"Of {total:,} extreme motions are lost, blown up or wrong without a word: {'; '.join(parts)}."


def checks(rows: Rows) -> list[Check]:
    """Return whether a method of this package blew up anywhere, or solved a step on a wrong branch."""
    found = []
    for name in in_order(set(distinct(rows, "method"))):
        own = find(rows, method=name)
        if name in OWN:
            blown = len(find(own, outcome=FAILED))
            found.append(
                Check(
                    f"{title_of(name)} never blows up in extremes", f"{blown} of {len(own)}", "0", blown == 0
                )
            )
        looked_at = [row for row in own if "branch_steps" in row]
        if looked_at:
            other, all_steps = total(looked_at, "branch_other"), total(looked_at, "branch_steps")
            found.append(
                Check(
                    f"{title_of(name)} never takes a wrong branch in silence",
                    f"{other} of {number(all_steps)} steps",
                    "0",
                    other == 0 and all_steps > 0,
                )
            )
    return found
