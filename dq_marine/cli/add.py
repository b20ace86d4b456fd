"""The command `dq-marine add`: which files an addition touches, and a template that works."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer
from rich.box import SIMPLE
from rich.table import Table
from rich.text import Text

from dq_marine.cli.additions import ADDITIONS, Addition
from dq_marine.cli.common import console, examples
from dq_marine.errors import InvalidInputError

EXAMPLES = examples(
    "dq-marine add",
    "dq-marine add task",
    "dq-marine add task --template > depth_keeping.py",
    "dq-marine add sensor",
)


class Kind(StrEnum):
    """What can be added."""

    TASK = "task"
    FORCE = "force"
    SENSOR = "sensor"
    REWARD = "reward"
    VEHICLE = "vehicle"


def add(
    kind: Annotated[Kind | None, typer.Argument(help="What to add.", show_default="all, as a table")] = None,
    template: Annotated[
        bool, typer.Option("--template", help="Print the template alone, to be written into a file.")
    ] = False,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print it as docs/architecture.md has it.")
    ] = False,
) -> None:
    """Say how to add a task, a force, a sensor, a reward term or a vehicle: files, a template, a command that shows it.

    Everything works from outside the package, too, by one call.
    """
    chosen = list(ADDITIONS.values()) if kind is None else [ADDITIONS[kind]]
    if template:
        if kind is None:
            raise InvalidInputError(f"--template is of one thing; name it: {', '.join(ADDITIONS)}")
        typer.echo(chosen[0].text, nl=False)
    elif markdown:
        typer.echo("\n".join(one.markdown() for one in chosen), nl=False)
    elif kind is None:
        console.print(_overview(chosen))
    else:
        _print_addition(chosen[0])


def _overview(additions: list[Addition]) -> Table:
    table = Table(box=SIMPLE, pad_edge=False, caption="More of one, with a template: dq-marine add NAME")
    for heading in ("add", "from outside the package", "files inside the package"):
        table.add_column(heading, overflow="fold")
    for one in additions:
        paths = "\n".join(change.path for change in one.inside)
        table.add_row(Text(one.name, "bold"), Text(one.outside), Text(paths))
    return table


def _print_addition(addition: Addition) -> None:
    console.print(Text(addition.what))
    console.print(Text.assemble(("\nFrom outside the package: ", "bold"), addition.outside))
    console.print(Text("\nFiles inside the package", "bold"))
    for change in addition.inside:
        console.print(Text.assemble("- ", (change.path, "cyan"), f": {change.change}"))
    console.print(Text.assemble(("\nTemplate ", "bold"), (addition.template, "cyan")))
    typer.echo(addition.text)  # whole lines, so that they can be copied
    console.print(Text("Show the result, in the folder of the template", "bold"))
    console.print(Text(f"  {addition.result}"), soft_wrap=True)
