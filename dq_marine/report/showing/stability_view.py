"""What the study of stability shows."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from dq_marine.report.names import in_order, title_of
from dq_marine.report.plan import Rows, distinct, find
from dq_marine.report.presentation import Check, Drawing, Table, listed, number
from dq_marine.report.showing.axes import make_logarithmic
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import BLUE, INK, VERMILLION, style_of

RK4_REAL, RK4_IMAGINARY = 2.785293563405282, 2.0 * math.sqrt(2.0)
"""Where RK4's stability region ends on the negative real axis and on the imaginary one."""

DOP853_REAL, DOP853_IMAGINARY = 6.39369, 5.96043
"""The same of DOP853."""

TITLES = {
    "damping": ("Damping: largest stable step", "damping rate lambda [1/s]"),
    "restoring": ("Righting moment: largest stable step", "natural frequency omega [rad/s]"),
    "vehicle": ("BlueROV2 Heavy under thrust: largest bounded step", "its damping, times"),
}
BOUNDS: dict[str, dict[str, float]] = {
    "damping": {
        "rk4_quaternion": RK4_REAL,
        "rk4_euler": RK4_REAL,
        "rk4_transported": RK4_REAL,
        "rkmk4": RK4_REAL,
        "dop853": DOP853_REAL,
        "explicit_euler": 2.0,
        "semi_implicit_euler": 2.0,
        "dqvi_paper": math.inf,
        "dqvi2": math.inf,
        "dqvi4": math.inf,
        "gauss8": math.inf,
        "galerkin8": math.inf,
        "rk4": math.inf,
        "rk8": math.inf,
    },
    "restoring": {
        "rk4_quaternion": RK4_IMAGINARY,
        "rk4_euler": RK4_IMAGINARY,
        "rk4_transported": RK4_IMAGINARY,
        "rkmk4": RK4_IMAGINARY,
        "dop853": DOP853_IMAGINARY,
        "explicit_euler": 0.0,
        "semi_implicit_euler": 2.0,
        "dqvi_paper": 2.0,
        "dqvi2": 2.0,
    },
}
"""What theory says: h lambda, or h omega, beyond which a method fails. Infinite: never. Zero: always."""

TOLERANCE = 0.02
"""Of a bound, relative: the runs are finite."""

CEILING = 10.0
"""The largest step that is tried [s]."""


def drawings(rows: Rows) -> list[Drawing]:
    """Return a map a kind of stiffness: a panel a method."""
    return [
        Drawing(
            f"stability-{kind}",
            TITLES[kind][0],
            "Blue: stable. Hatched: the method fails, by blowing up or, where the panel says so, by refusing the step. "
            f"Dashed: the bound from theory. Steps up to {CEILING:g} s were tried.",
            partial(draw, find(rows, kind=kind), kind),
        )
        for kind in distinct(rows, "kind")
    ]


def draw(rows: Rows, kind: str) -> Any:
    """Return the figure of one kind of stiffness."""
    names = in_order(set(distinct(rows, "method")))
    columns = 4
    lines = -(-len(names) // columns)
    figure = new_figure(12.0, 0.4 + 2.35 * lines)
    grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(names) :]:
        axes.set_visible(False)
    floor = 10.0 ** math.floor(math.log10(min(row["largest_step"] or CEILING for row in rows)) - 1.0)
    for axes, name in zip(grid.flat, names, strict=False):
        draw_panel(axes, find(rows, method=name), BOUNDS.get(kind, {}).get(name), floor)
        axes.set_title(title_of(name), fontsize=9.5)
    for axes in grid[-1]:
        axes.set_xlabel(TITLES[kind][1])
    for position in range(len(names) - columns, len(names)):
        if 0 <= position < len(names):
            grid.flat[position].tick_params(labelbottom=True)
            grid.flat[position].set_xlabel(TITLES[kind][1])
    for line in grid:
        line[0].set_ylabel("step h [s]")
    return figure


def draw_panel(axes: Any, rows: Rows, bound: float | None, floor: float) -> None:
    """Draw where one method is stable, where it fails, and what theory says."""
    make_logarithmic(axes)
    stiffness = [row["stiffness"] for row in rows]
    limits = [row["largest_step"] or floor for row in rows]
    style = style_of(rows[0]["method"])
    axes.fill_between(stiffness, limits, floor, color=BLUE, alpha=0.25, linewidth=0)
    axes.fill_between(
        stiffness, limits, CEILING, facecolor="none", edgecolor=VERMILLION, hatch="///", linewidth=0
    )
    axes.plot(stiffness, limits, **style.arguments() | {"linestyle": "-"})
    if bound is not None and math.isfinite(bound) and bound > 0.0:
        axes.plot(stiffness, [bound / value for value in stiffness], color=INK, linestyle="--", linewidth=1.1)
    axes.set_ylim(floor, 1.6 * CEILING)
    text = remark(rows, bound)
    axes.text(0.04, 0.06, text, transform=axes.transAxes, fontsize=8.5, bbox=BOX)


BOX = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}


def remark(rows: Rows, bound: float | None) -> str:
    """Return in words what a panel shows."""
    refusals = sorted({row["failure"] for row in rows if row["failure"] not in ("", "blew up")})
    if all(row["failing_step"] is None for row in rows):
        words = "no failure found"
    elif all(row["largest_step"] is None for row in rows):
        words = "no stable step found"
    elif refusals:
        words = f"refuses: {', '.join(refusals).replace('_', ' ')}"
    else:
        words = "blows up"
    theory = {0.0: "theory: never stable", math.inf: "theory: no bound"}
    if bound is not None:
        words += "\n" + theory.get(bound, f"theory: {bound:.3g}")
    return words


def tables(rows: Rows) -> list[Table]:
    """Return the bounds found, as products with the stiffness, beside those of theory."""
    found = []
    for kind in distinct(rows, "kind"):
        own = find(rows, kind=kind)
        values = sorted(set(distinct(own, "stiffness")))
        bounds = BOUNDS.get(kind)
        lines = []
        for name in in_order(set(distinct(own, "method"))):
            cells = [
                cell(find(own, method=name, stiffness=value), scaled=bounds is not None) for value in values
            ]
            theory = [] if bounds is None else [in_theory(bounds.get(name))]
            lines.append([title_of(name), *theory, *cells])
        found.append(Table(table_title(kind), table_header(kind, values), lines, table_note(kind)))
    return found


def table_title(kind: str) -> str:
    """Return what a table holds."""
    return {
        "damping": "Damping: largest stable h lambda",
        "restoring": "Righting moment: largest stable h omega",
        "vehicle": "BlueROV2 Heavy: largest bounded step [s]",
    }[kind]


def table_header(kind: str, values: list[float]) -> list[str]:
    """Return the names of the columns."""
    symbol = {"damping": "lambda = ", "restoring": "omega = ", "vehicle": "damping x "}[kind]
    return ["method", *(["theory"] if kind in BOUNDS else []), *(f"{symbol}{value:g}" for value in values)]


def table_note(kind: str) -> str:
    """Return what the entries mean."""
    absent = (
        "Composed orders 6 and 8 have negative stages, which damping forbids. " if kind != "restoring" else ""
    )
    return f"{absent}'>': stable up to the largest step tried. 'none': no stable step found."


def cell(rows: Rows, *, scaled: bool) -> str:
    """Return one bound."""
    if not rows:
        return ""
    row = rows[0]
    if row["largest_step"] is None:
        return "none"
    value = row["largest_step"] * (row["stiffness"] if scaled else 1.0)
    return f"> {number(value, 3)}" if row["failing_step"] is None else number(value, 4)


def in_theory(bound: float | None) -> str:
    """Return a theoretical bound in words."""
    if bound is None:
        return ""
    return {0.0: "0", math.inf: "none"}.get(bound, f"{bound:.4g}")


def findings(rows: Rows) -> list[str]:
    """Return who fails where."""
    sentences = []
    damped = find(rows, kind="damping")
    free = [
        title_of(name)
        for name in in_order(set(distinct(damped, "method")))
        if all(row["failing_step"] is None for row in find(damped, method=name))
    ]
    if free:
        stiffest = max(row["stiffness"] * CEILING for row in damped)
        sentences.append(f"No damping, up to h lambda = {number(stiffest)}, makes {listed(free)} fail.")
    vehicle = find(rows, kind="vehicle")
    for name in ("dqvi2", "rk4_quaternion", "semi_implicit_euler"):
        own = find(vehicle, method=name)
        if own:
            sentences.append(f"{title_of(name)}, BlueROV2 Heavy under thrust: {in_words(own)}.")
    return sentences


def in_words(rows: Rows) -> str:
    """Return the largest bounded steps of one method."""
    parts = []
    for row in rows:
        step = row["largest_step"]
        size = "no step" if step is None else f"h = {number(step)} s"
        more = " and more" if row["failing_step"] is None else ""
        parts.append(f"{size}{more} with {row['stiffness']:g} times the damping")
    return "bounded to " + ", ".join(parts)


def checks(rows: Rows) -> list[Check]:
    """Return the bounds found, held against those of theory."""
    found = []
    for kind, bounds in BOUNDS.items():
        for name, bound in bounds.items():
            own = find(rows, kind=kind, method=name)
            if own:
                found.append(bound_check(kind, name, bound, own))
    return found


def bound_check(kind: str, name: str, bound: float, rows: Rows) -> Check:
    """Return a method's bounds held against theory's."""
    agrees: Callable[[Any], bool]
    if bound == math.inf:
        measured, agrees = "no failure", lambda row: row["failing_step"] is None
    elif bound == 0.0:
        measured, agrees = "no stable step", lambda row: row["largest_step"] is None
    else:
        products = [product(row) for row in rows if row["failing_step"] is not None]
        measured = (
            " to ".join(dict.fromkeys(f"{edge:.3f}" for edge in (min(products), max(products))))
            if products
            else ""
        )
        agrees = partial(near, bound=bound)
    wrong = [row for row in rows if not agrees(row)]
    if wrong:
        measured = ", ".join(f"{cell([row], scaled=True)} at {row['stiffness']:g}" for row in wrong)
    symbol = "h lambda" if kind == "damping" else "h omega"
    return Check(
        f"{kind} bound of {title_of(name)}",
        measured,
        {math.inf: "no bound", 0.0: "never stable"}.get(
            bound, f"{symbol} = {bound:.4g} within {TOLERANCE:.0%}"
        ),
        not wrong,
    )


def product(row: dict[str, Any]) -> float:
    """Return h lambda, or h omega, of the largest stable step."""
    return float((row["largest_step"] or 0.0) * row["stiffness"])


def near(row: dict[str, Any], bound: float) -> bool:
    """Whether a bound was found where theory has it; one beyond the largest step tried must not be found."""
    if bound / row["stiffness"] > CEILING:
        return row["failing_step"] is None
    return abs(product(row) / bound - 1.0) <= TOLERANCE
