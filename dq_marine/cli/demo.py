"""The command `dq-marine demo`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples

EXAMPLES = examples("dq-marine demo", "dq-marine demo --out my_demo")


def demo(
    out: Annotated[Path, typer.Option("--out", help="Folder for replays, index.html and errors.png.")] = Path(
        "demo"
    ),
) -> None:
    """Watch station keeping in a current by a controller and by a trained policy, docking, and vessels that meet.

    Writes replays to open in any browser, a page with all of them side by side, and a plot of errors and thrust. Where
    there is a display, it also flies live.
    """
    from dq_marine.agents.demo import run_demo

    run_demo(out, console)
