"""What the study of the terms shows."""

from __future__ import annotations

from typing import Any

from dq_marine.report.axes import new_figure
from dq_marine.report.lean_scenes import EVERYTHING, NOTHING
from dq_marine.report.plan import Row, Rows, distinct, find
from dq_marine.report.presentation import Drawing, Table, duration, factor
from dq_marine.report.style import BLUE, GREEN, GREY, INK

COLOURS = {"one body": BLUE, "batch": GREEN}


def drawings(rows: Rows) -> list[Drawing]:
    """Return a bar a term, for each engine."""
    return [
        Drawing(
            "terms",
            "Time a step with nothing, with each term alone, and with everything",
            "Shortest of the samples. Dashed: inertia alone. What a scene does not have costs nothing.",
            lambda: bars(rows),
        )
    ]


def bars(rows: Rows) -> Any:
    """Return the figure."""
    engines = distinct(rows, "engine")
    figure = new_figure(10.5, 3.6)
    panels = figure.subplots(1, len(engines), sharey=True, squeeze=False)[0]
    for axes, engine in zip(panels, engines, strict=True):
        draw_engine(axes, find(rows, engine=engine), COLOURS.get(engine, GREY))
        axes.set_title("one body" if engine == "one body" else "batch, a step of one body, one core")
    return figure


def draw_engine(axes: Any, rows: Rows, colour: str) -> None:
    """Draw the bars of one engine."""
    names = [label(row) for row in rows]
    times = [row["best_ns"] for row in rows]
    hatches = ["//" if row["terms"] in (NOTHING, EVERYTHING) else "" for row in rows]
    placed = axes.barh(names, times, color=colour, alpha=0.75, edgecolor="white", hatch=hatches, height=0.7)
    axes.bar_label(placed, [f"{time:,.0f}" if time >= 100 else f"{time:.1f}" for time in times], padding=3)
    axes.axvline(times[0], color=INK, linestyle="--", linewidth=0.9)
    axes.set_xlim(0.0, 1.15 * max(times))
    axes.set_xlabel("ns a step")
    axes.grid(visible=False, axis="y")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()


def label(row: Row) -> str:
    """Return what a bar is named."""
    name = str(row["terms"])
    return name if name in (NOTHING, EVERYTHING) else f"+ {name}"


def tables(rows: Rows) -> list[Table]:
    """Return times, what a term adds, and iterations."""
    lines = []
    for name in distinct(rows, "terms"):
        line = [name if name in (NOTHING, EVERYTHING) else f"+ {name}"]
        for engine in distinct(rows, "engine"):
            line += cells(rows, engine, name)
        lines.append(line)
    header = ["scene"]
    for engine in distinct(rows, "engine"):
        header += [f"{engine} [ns]", "median [ns]", "over inertia alone"]
        header += ["Newton iterations a step"] if engine == "one body" else []
    return [Table("Time a step", header, lines)]


def cells(rows: Rows, engine: str, name: str) -> list[str]:
    """Return one engine's cells of one scene."""
    bare, row = (find(rows, engine=engine, terms=terms) for terms in (NOTHING, name))
    if not bare or not row:
        return [""] * (4 if engine == "one body" else 3)
    found = [
        f"{row[0]['best_ns']:.4g}",
        f"{row[0]['median_ns']:.4g}",
        factor(row[0]["best_ns"] / bare[0]["best_ns"]),
    ]
    return found + ([f"{row[0]['iterations']:.2f}"] if engine == "one body" else [])


def findings(rows: Rows, bare_name: str = NOTHING) -> list[str]:
    """Return what leaving terms out saves."""
    sentences = []
    for engine in distinct(rows, "engine"):
        bare, full = find(rows, engine=engine, terms=bare_name), find(rows, engine=engine, terms=EVERYTHING)
        if bare and full:
            least, most = bare[0]["best_ns"] * 1e-9, full[0]["best_ns"] * 1e-9
            where = "One body" if engine == "one body" else f"In a batch of {bare[0]['bodies']:,} bodies, one"
            sentences.append(
                f"{where} takes {duration(least)} a step with inertia alone and {duration(most)} with everything: "
                f"a scene that needs nothing else is {factor(most / least)} as fast."
            )
    return sentences
