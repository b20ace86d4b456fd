"""The command `dq-marine report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples

EXAMPLES = examples(
    "dq-marine report --quick",
    "dq-marine report --out my_report",
    "dq-marine report --only work_precision --case kirchhoff_bluerov2",
)


def report(
    quick: Annotated[
        bool,
        typer.Option(
            "--quick", help="Make a small report in a few minutes; the full one takes half an hour."
        ),
    ] = False,
    out: Annotated[Path, typer.Option("--out", help="Folder for the page and the points.")] = Path("report"),
    only: Annotated[
        list[str] | None,
        typer.Option("--only", help="A study to measure; may be repeated.", show_default="all"),
    ] = None,
    case: Annotated[
        list[str] | None,
        typer.Option("--case", help="A case of work_precision; may be repeated.", show_default="all"),
    ] = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="Measure again what was measured before.")] = False,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Seed of the random draws.")] = 0,
) -> None:
    """Compare the integrator with others: error against run time, long runs, stability, extremes.

    Writes a page to read, and every point. What was measured before is kept, unless the sources have changed. Fails if
    what was measured contradicts theory.
    """
    from dq_marine.report.command import Request, make_report
    from dq_marine.report.plan import Plan
    from dq_marine.report.runner import InterruptedRunError

    request = Request(out, tuple(only or ()), Plan(quick, seed, tuple(case or ())), fresh)
    try:
        page = make_report(request, console)
    except InterruptedRunError as stopped:
        console.print(
            f"Stopped; {stopped.measured} of {stopped.wanted} parts are measured and kept. Go on: {request.command}",
            soft_wrap=True,
        )
        raise typer.Exit(130) from None
    if page.failures:
        raise typer.Exit(1)
