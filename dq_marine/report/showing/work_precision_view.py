"""What the study of error against cost shows."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple

from dq_marine.report.cases import CASES
from dq_marine.report.methods import WITH_STAGES
from dq_marine.report.names import RIVALS, case_title, in_order, order_of, title_of
from dq_marine.report.plan import Rows, distinct
from dq_marine.report.presentation import (
    Check,
    Drawing,
    Table,
    duration,
    factor,
    listed,
    number,
    power,
)
from dq_marine.report.showing.axes import add_legend, add_slope_guides, make_logarithmic
from dq_marine.report.showing.curves import (
    BASELINE,
    EVALUATIONS,
    QUANTITIES,
    TIME,
    Curve,
    best_own,
    cheapest,
    curves_of,
)
from dq_marine.report.showing.orders import order_checks, order_table
from dq_marine.report.showing.overview import draw_overview
from dq_marine.report.showing.rates import kind_of
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import style_of

TARGETS = (1e-2, 1e-4, 1e-6, 1e-8)
SHOWN_ERRORS = (1e-13, 30.0)
COST_LABELS = {
    TIME: "wall time per simulated second [s]",
    EVALUATIONS: "force evaluations per simulated second",
}
SCALES = {TIME: 1e-9, EVALUATIONS: 1.0}
NOT_REACHED = "-"
USUAL_STEP = 0.02
"""What simulators of marine vehicles take [s]."""


class Opponent(NamedTuple):
    """What the fastest method of this package is held against: methods, by how they are called."""

    title: str
    short: str
    methods: tuple[str, ...]

    def cost_at(self, curves: dict[str, Curve], quantity: str, target: float) -> float | None:
        """Return the time of the fastest of them for an error, None if none reaches it."""
        found = cheapest(self.methods, curves, quantity, target)
        return None if found is None else found[1]


USUAL = Opponent(title_of(BASELINE), "RK4", (BASELINE,))
STRONGEST = Opponent("the fastest baseline", "a baseline", RIVALS)
"""DOP853 in most cases; each case and error has its own."""


def drawings(rows: Rows) -> list[Drawing]:
    """Return an overview, and a figure a case: three errors against time, and against evaluations."""
    all_curves = {case: curves_of(rows, case) for case in distinct(rows, "case")}
    overview = Drawing(
        "work-precision-overview",
        f"This package and {title_of(BASELINE)}, by the error that is wanted",
        "A line is drawn where both get there. Errors fall to the right.",
        partial(draw_overview, all_curves),
    )
    figures = [
        Drawing(f"work-precision-{case}", case_title(case), caption(case), partial(draw_case, curves))
        for case, curves in all_curves.items()
    ]
    return [overview, *figures]


def caption(case: str) -> str:
    """Return how to read the figure of a case."""
    note = f"{CASES[case].note} " if case in CASES else ""
    return (
        f"{note}Lower and further left is better. Grey: slopes 2, 4 and 6. Crosses along the upper edge: steps at "
        "which a method failed."
    )


def draw_case(curves: dict[str, Curve]) -> Any:
    """Return the figure of one case."""
    figure = new_figure(12.0, 7.6)
    panels = figure.subplots(2, 3, sharex="row", sharey="col")
    for line, cost in zip(panels, COST_LABELS, strict=True):
        for axes, (quantity, label) in zip(line, QUANTITIES.items(), strict=True):
            draw_curves(axes, curves, quantity, cost)
            axes.set_ylabel(label)
            axes.set_xlabel(COST_LABELS[cost])
    for axes in panels.flat:
        add_slope_guides(axes, (2, 4, 6))
    add_legend(figure, curves, {name: title_of(name) for name in curves}, columns=4)
    return figure


def draw_curves(axes: Any, curves: dict[str, Curve], quantity: str, cost: str) -> None:
    """Draw all methods into one panel."""
    make_logarithmic(axes)
    low, high = SHOWN_ERRORS
    for name, curve in curves.items():
        pairs = zip(curve.costs(cost), curve.errors(quantity, cost), strict=True)
        shown = [(SCALES[cost] * x, min(max(y, 2.0 * low), 0.7 * high)) for x, y in pairs if math.isfinite(y)]
        if shown:
            axes.plot(*zip(*shown, strict=True), **style_of(name).arguments())
        failed = [SCALES[cost] * row[cost] for row in curve.failures if cost in row]
        axes.plot(failed, [0.7 * high] * len(failed), "x", color=style_of(name).colour, markersize=5)
    axes.set_ylim(low, high)


def tables(rows: Rows) -> list[Table]:
    """Return who wins where, the observed orders, and the times of every method on every case."""
    all_curves = {case: curves_of(rows, case) for case in distinct(rows, "case")}
    found = [ratio_table(all_curves, quantity, USUAL) for quantity in ("attitude", "position")]
    found += [ratio_table(all_curves, "attitude", STRONGEST)]
    found += [order_table(all_curves), same_step_table(all_curves)]
    for case, curves in all_curves.items():
        found += [time_table(case, curves, quantity) for quantity in ("attitude", "position")]
    return found


def ratio_table(all_curves: dict[str, dict[str, Curve]], quantity: str, opponent: Opponent) -> Table:
    """Return the time of the best own method over that of an opponent, by case and error."""
    lines = []
    for case, curves in all_curves.items():
        lines.append(
            [case_title(case), *(ratio_cell(curves, quantity, target, opponent) for target in TARGETS)]
        )
    return Table(
        f"Time of the fastest method of this package over that of {opponent.title}, by {QUANTITIES[quantity]}",
        ["case", *(f"{power(target)}" for target in TARGETS)],
        lines,
        "Below 1, this package is faster. In brackets the order of the fastest. Read off between measured points.",
    )


def ratio_cell(curves: dict[str, Curve], quantity: str, target: float, opponent: Opponent) -> str:
    """Return one ratio, with the order of the own method that it is for."""
    own, other = best_own(curves, quantity, target), opponent.cost_at(curves, quantity, target)
    if own is None:
        return "this package: not reached" if other is not None else NOT_REACHED
    if other is None:
        return f"{opponent.short}: not reached ({short(own[0])})"
    return f"{factor(own[1] / other)} ({short(own[0])})"


def short(name: str) -> str:
    """Return a few letters for an own method."""
    return name.removeprefix("dqvi").removeprefix("_") or name


def same_step_table(all_curves: dict[str, dict[str, Curve]]) -> Table:
    """Return the attitude errors with a step as simulators take it."""
    names = in_order({name for curves in all_curves.values() for name in curves if order_of(name)})
    lines = [
        [title_of(name), *(same_step_cell(curves.get(name)) for curves in all_curves.values())]
        for name in names
    ]
    return Table(
        f"Attitude error [rad] with the step that is nearest to {USUAL_STEP:g} s",
        ["method", *(case_title(case) for case in all_curves)],
        lines,
        "What a simulation with a fixed step gets, whatever it costs.",
    )


def same_step_cell(curve: Curve | None) -> str:
    """Return the error of one method on one case."""
    if curve is None:
        return "cannot"
    rows = [row for row in [*curve.points, *curve.failures] if "step" in row]
    if not rows:
        return ""
    row = min(rows, key=lambda row: abs(math.log(row["step"] / USUAL_STEP)))
    return (
        number(row["attitude"]) if row.get("attitude") is not None else str(row["outcome"]).replace("_", " ")
    )


def time_table(case: str, curves: dict[str, Curve], quantity: str) -> Table:
    """Return the time that each method needs for each error."""
    lines = [
        [title_of(name), *(time_cell(curve.cost_at(quantity, target)) for target in TARGETS)]
        for name, curve in curves.items()
    ]
    return Table(
        f"{case_title(case)}: time per simulated second for a given {QUANTITIES[quantity]}",
        ["method", *(f"{power(target)}" for target in TARGETS)],
        lines,
        f"{NOT_REACHED}: not reached with the finest step tried.",
    )


def time_cell(nanoseconds: float | None) -> str:
    """Return a time, or that there is none."""
    return NOT_REACHED if nanoseconds is None else duration(nanoseconds * 1e-9)


def findings(rows: Rows) -> list[str]:
    """Return where this package wins and loses against RK4, and against the fastest baseline, in numbers."""
    all_curves = {case: curves_of(rows, case) for case in distinct(rows, "case")}
    found = [sentence for opponent in (USUAL, STRONGEST) for sentence in comparison(all_curves, opponent)]
    wins = [(case, target) for case, target, value in ratios(all_curves, USUAL) if value < 1.0]
    if wins:
        names = [
            f"{case_title(case)} ({', '.join(f'{power(t)}' for c, t in wins if c == case)})"
            for case, _ in wins
        ]
        found.append(f"This package is ahead of {USUAL.title} on {listed(list(dict.fromkeys(names)))}.")
    return found


Ratio = tuple[str, float, float]
"""Case, error, and time over the opponent's."""


def ratios(all_curves: dict[str, dict[str, Curve]], opponent: Opponent) -> list[Ratio]:
    """Return the ratios of all cases and errors that this package or the opponent reaches."""
    found = [
        (case, target, ratio(curves, target, opponent))
        for case, curves in all_curves.items()
        for target in TARGETS
    ]
    return [(case, target, value) for case, target, value in found if value is not None]


def comparison(all_curves: dict[str, dict[str, Curve]], opponent: Opponent) -> list[str]:
    """Return how this package and an opponent compare: in how many pairs, and by what factor."""
    known = ratios(all_curves, opponent)
    if not known:
        return []
    wins = sum(value < 1.0 for _, _, value in known)
    gist = (
        f"Of {len(known)} pairs of case and attitude error that this package or {opponent.title} reaches, the fastest "
        f"method of this package needs less time in {wins}, and more in {len(known) - wins}."
    )
    kinds = dict.fromkeys(kind_of(case) for case, _, _ in known)
    return [gist, *(sentence_of(kind, known, opponent) for kind in kinds)]


def ratio(curves: dict[str, Curve], target: float, opponent: Opponent) -> float | None:
    """Return the time of the fastest method of this package over that of an opponent for an attitude error.

    Zero where the opponent does not reach it, infinite where the package does not, None where neither does.
    """
    own, other = best_own(curves, "attitude", target), opponent.cost_at(curves, "attitude", target)
    if own is None:
        return None if other is None else math.inf
    return 0.0 if other is None else own[1] / other


def sentence_of(kind: str, known: list[Ratio], opponent: Opponent) -> str:
    """Return how this package and an opponent compare on one kind of motion."""
    parts = []
    for target in TARGETS:
        values = [value for case, error, value in known if kind_of(case) == kind and error == target]
        both = [value for value in values if 0.0 < value < math.inf]
        text = (
            f"{factor(geometric_mean(both))} at {power(target)} rad"
            if both
            else f"no common case at {power(target)} rad"
        )
        alone, lacking = values.count(0.0), values.count(math.inf)
        text += f", where {opponent.short} does not get in {alone} of {len(values)}" if alone else ""
        text += f", where this package does not get in {lacking} of {len(values)}" if lacking else ""
        parts.append(text)
    return f"Time of the fastest method of this package over that of {opponent.title}, {kind}: {'; '.join(parts)}."


def geometric_mean(values: list[float]) -> float:
    """Return the geometric mean."""
    return math.exp(sum(math.log(value) for value in values) / len(values))


def checks(rows: Rows) -> list[Check]:
    """Return the observed orders, held against those that the methods are said to have.

    Not of methods whose longest steps are left to a fallback of second order: errors are no power of the step there.
    Tests of the integrator hold their orders.
    """
    rows = [row for row in rows if row.get("method") not in WITH_STAGES]
    return order_checks({case: curves_of(rows, case) for case in distinct(rows, "case")})
