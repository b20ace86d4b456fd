"""What the study of the terms shows."""

from __future__ import annotations

from typing import Any

from dq_marine.report.lean_scenes import EVERYTHING, NOTHING
from dq_marine.report.plan import Row, Rows, distinct, find
from dq_marine.report.presentation import Drawing, Table, duration, factor
from dq_marine.util.figures import new_figure
from dq_marine.util.plot_style import BLUE, GREEN, GREY, INK

COLOURS = {"one body": BLUE, "batch": GREEN}


def drawings(rows: Rows) -> list[Drawing]:
    """Return a bar a term, for each backend."""
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
    backends = distinct(rows, "backend")
    figure = new_figure(10.5, 3.6)
    panels = figure.subplots(1, len(backends), sharey=True, squeeze=False)[0]
    for axes, backend in zip(panels, backends, strict=True):
        draw_backend(axes, find(rows, backend=backend), COLOURS.get(backend, GREY))
        axes.set_title("one body" if backend == "one body" else "batch, a step of one body, one core")
    return figure


def draw_backend(axes: Any, rows: Rows, colour: str) -> None:
    """Draw the bars of one backend."""
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
        for backend in distinct(rows, "backend"):
            line += cells(rows, backend, name)
        lines.append(line)
    header = ["scene"]
    for backend in distinct(rows, "backend"):
        header += [f"{backend} [ns]", "median [ns]", "over inertia alone"]
        header += ["Newton iterations a step"] if backend == "one body" else []
    return [Table("Time a step", header, lines)]


def cells(rows: Rows, backend: str, name: str) -> list[str]:
    """Return one backend's cells of one scene."""
    bare, row = (find(rows, backend=backend, terms=terms) for terms in (NOTHING, name))
    if not bare or not row:
        return [""] * (4 if backend == "one body" else 3)
    found = [
        f"{row[0]['best_ns']:.4g}",
        f"{row[0]['median_ns']:.4g}",
        factor(row[0]["best_ns"] / bare[0]["best_ns"]),
    ]
    return found + ([f"{row[0]['iterations']:.2f}"] if backend == "one body" else [])


def findings(rows: Rows, bare_name: str = NOTHING) -> list[str]:
    """Return what leaving terms out saves."""
    sentences = []
    for backend in distinct(rows, "backend"):
        bare, full = (
            find(rows, backend=backend, terms=bare_name),
            find(rows, backend=backend, terms=EVERYTHING),
        )
        if bare and full:
            least, most = bare[0]["best_ns"] * 1e-9, full[0]["best_ns"] * 1e-9
            where = (
                "One body" if backend == "one body" else f"In a batch of {bare[0]['bodies']:,} bodies, one"
            )
            sentences.append(
                f"{where} takes {duration(least)} a step with inertia alone and {duration(most)} with everything: "
                f"a scene that needs nothing else is {factor(most / least)} as fast."
            )
    return sentences
