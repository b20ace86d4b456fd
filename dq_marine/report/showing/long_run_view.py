"""What the study of long runs shows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dq_marine.report.names import KEEPING, in_order, title_of
from dq_marine.report.plan import Row, Rows, distinct, find
from dq_marine.report.presentation import Check, Drawing, Table, factor, listed, number
from dq_marine.report.showing.axes import add_legend, drawable, make_logarithmic
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import style_of

DONE = "done"
SHOWN = (1e-17, 1e3)
ERRORS = {"energy_error": "energy error", "linear_momentum_error": "momentum error"}

KEPT_MOMENTUM = 1e-10
"""Largest change of DQVI's linear momentum, relative: round-off over all steps, averaged out."""

KEPT_ENERGY = 0.05
"""Largest energy error of DQVI, relative to the kinetic energy: bounded, for these steps."""

GROWN_ENERGY = 3.0
"""Largest ratio of DQVI's energy errors in the last tenth of a run to those up to a tenth: bounded, no drift."""

ROUND_OFF = 1e-9
"""Energy error below which nothing is asked: sums of round-off wander."""


def drawings(rows: Rows) -> list[Drawing]:
    """Return energy and momentum errors over time, by case and step size."""
    return [
        Drawing(
            "long-run",
            "Energy and momentum over a long run",
            "Errors relative to the start, largest so far, over simulated time. A line that ends in a cross: the "
            "method blew up. A level line is bounded; a slope of 1 is a steady drift.",
            lambda: draw(rows),
        )
    ]


def draw(rows: Rows) -> Any:
    """Return the figure."""
    panels = [(case, step) for case in distinct(rows, "case") for step in distinct(rows, "step")]
    figure = new_figure(13.0, 7.2)
    grid = figure.subplots(len(ERRORS), len(panels), sharey="row", squeeze=False)
    for line, (quantity, label) in zip(grid, ERRORS.items(), strict=True):
        for axes, (case, step) in zip(line, panels, strict=True):
            draw_panel(axes, find(rows, case=case, step=step), quantity)
            axes.set_xlabel("time [s]")
        line[0].set_ylabel(f"{label}, largest so far")
    for axes, (case, step) in zip(grid[0], panels, strict=True):
        axes.set_title(f"{find(rows, case=case)[0]['title']}\nh = {step:g} s", fontsize=9.5)
    names = in_order(set(distinct(rows, "method")))
    add_legend(figure, names, {name: title_of(name) for name in names}, columns=4)
    return figure


def draw_panel(axes: Any, rows: Rows, quantity: str) -> None:
    """Draw the errors of all methods."""
    make_logarithmic(axes)
    low, high = SHOWN
    for name in in_order(set(distinct(rows, "method"))):
        own = find(rows, method=name)
        times, sizes = series(own, quantity)
        style = style_of(name)
        shown = np.minimum(drawable(sizes, 2.0 * low), 0.5 * high)
        axes.plot(times, shown, **style.arguments() | {"markevery": max(1, len(times) // 6)})
        if own[-1]["outcome"] != DONE:
            axes.plot(own[-1]["time"], 0.5 * high, "x", color=style.colour, markersize=7, markeredgewidth=2)
    axes.set_ylim(low, high)


def series(rows: Rows, quantity: str) -> tuple[list[float], list[float]]:
    """Return times, and the largest size of an error up to them; infinite where it is not finite."""
    kept = [row for row in rows if row["outcome"] == DONE]
    sizes = [abs(row[quantity]) if row[quantity] is not None else math.inf for row in kept]
    return [row["time"] for row in kept], np.maximum.accumulate(sizes).tolist() if sizes else []


def tables(rows: Rows) -> list[Table]:
    """Return the largest errors of each method, by case and step size."""
    found = []
    for case in distinct(rows, "case"):
        steps = distinct(find(rows, case=case), "step")
        lines = []
        for name in in_order(set(distinct(find(rows, case=case), "method"))):
            line = [title_of(name)]
            for step in steps:
                line += cells(find(rows, case=case, method=name, step=step))
            lines.append(line)
        header = ["method"]
        for step in steps:
            header += [f"energy, h = {step:g} s", "linear momentum", "angular momentum"]
        title = find(rows, case=case)[0]["title"]
        total = max(row["steps"] for row in find(rows, case=case))
        found.append(Table(f"{title}: largest relative errors in {total:,} steps", header, lines))
    return found


def cells(rows: Rows) -> list[str]:
    """Return a run's largest errors."""
    if not rows:
        return ["", "", ""]
    if rows[-1]["outcome"] != DONE:
        return [f"{rows[-1]['outcome']} by {rows[-1]['time']:,.0f} s", "", ""]
    return [number(largest(rows, name)) for name in (*ERRORS, "angular_momentum_error")]


def largest(rows: Rows, quantity: str) -> float:
    """Return the largest size of an error; infinite if the run failed."""
    failed = rows[-1]["outcome"] != DONE
    sizes = series(rows, quantity)[1]
    return math.inf if failed or not sizes else sizes[-1]


def growth(rows: Rows) -> float:
    """Return the largest energy error of the last tenth of a run over that of its first tenth."""
    total = rows[-1]["steps"]
    early = [abs(row["energy_error"]) for row in rows if row["steps"] <= 0.1 * total]
    late = [abs(row["energy_error"]) for row in rows if row["steps"] >= 0.9 * total]
    return float(max(late) / max(max(early), 1e-300))


def runs(rows: Rows) -> list[tuple[Row, Rows]]:
    """Return each run's first row and all of them."""
    found = []
    for case in distinct(rows, "case"):
        for step in distinct(rows, "step"):
            for name in in_order(set(distinct(rows, "method"))):
                own = find(rows, case=case, step=step, method=name)
                if own:
                    found.append((own[0], own))
    return found


def findings(rows: Rows) -> list[str]:
    """Return what DQVI keeps and others lose."""
    sentences = []
    for case in distinct(rows, "case"):
        step = max(distinct(rows, "step"))
        own = find(rows, case=case, step=step, method="dqvi2")
        baseline = find(rows, case=case, step=step, method="rk4_quaternion")
        if own and baseline:
            sentences.append(comparison(own, baseline))
    failed = sorted({title_of(run["method"]) for run, own in runs(rows) if own[-1]["outcome"] != DONE})
    if failed:
        sentences.append(f"Blew up or gave up in at least one of the runs: {listed(failed)}.")
    return sentences


def comparison(own: Rows, baseline: Rows) -> str:
    """Return how DQVI of order 2 and RK4 fare at one step size."""
    mine, theirs = largest(own, "energy_error"), largest(baseline, "energy_error")
    times = f", {factor(theirs / mine)} as large" if math.isfinite(theirs) and mine > 0.0 else ""
    momenta = [number(largest(run, "linear_momentum_error")) for run in (own, baseline)]
    names = [title_of(run[0]["method"]) for run in (own, baseline)]
    return (
        f"{own[0]['title']}, {own[-1]['steps']:,} steps of {own[0]['step']:g} s: {names[0]} is off by at most "
        f"{number(mine)} in energy and {momenta[0]} in momentum, {names[1]} by {number(theirs)} in energy{times}, and "
        f"{momenta[1]} in momentum."
    )


def checks(rows: Rows) -> list[Check]:
    """Return what a variational integrator must keep: momentum to round-off, energy in bounds and without drift."""
    found = []
    for run, own in runs(rows):
        if run["method"] not in KEEPING:
            continue
        name = f"{title_of(run['method'])}, {run['title']}, h = {run['step']:g} s"
        momentum = largest(own, "linear_momentum_error")
        energy = largest(own, "energy_error")
        grows = growth(own) if math.isfinite(energy) else math.inf
        kept = energy <= ROUND_OFF or (energy <= KEPT_ENERGY and grows <= GROWN_ENERGY)
        found += [
            Check(
                f"momentum of {name}",
                number(momentum),
                f"at most {KEPT_MOMENTUM:g}",
                momentum <= KEPT_MOMENTUM,
            ),
            Check(
                f"energy of {name}",
                f"{number(energy)}, grown {number(grows)} times",
                f"at most {KEPT_ENERGY:g} and grown at most {GROWN_ENERGY:g} times",
                kept,
            ),
        ]
    return found
