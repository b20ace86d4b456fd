"""The command `dq-marine demo`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples

EXAMPLES = examples("dq-marine demo", "dq-marine demo --out my_demo")


def demo(
    out: Annotated[Path, typer.Option("--out", help="Folder for replay.html and errors.png.")] = Path("demo"),
) -> None:
    """Watch a PID controller hold station in a current.

    Writes a replay to open in any browser, and a plot of errors and thrust. Where there is a display, it also flies
    live.
    """
    from dq_marine.agents.evaluation.demo import run_demo

    run_demo(out, console)
