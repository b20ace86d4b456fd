"""The command `dq-marine tasks`: the registered tasks, and what each consists of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples

if TYPE_CHECKING:
    from dq_marine.cli.task_tables import TextTable

EXAMPLES = examples("dq-marine tasks", "dq-marine tasks StationKeeping", "dq-marine tasks --markdown")


def tasks(
    task: Annotated[
        str | None, typer.Argument(help="Id or name of a task.", show_default="all, in one table")
    ] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="Tables as Markdown.")] = False,
) -> None:
    """List the tasks; or show a task's action, observation, reward, metrics and keywords."""
    from dq_marine.cli.task_tables import description, task_table
    from dq_marine.envs.core.registry import task_called

    if task is None:
        tables: tuple[TextTable, ...] = (task_table(),)
    else:
        definition = task_called(task)
        tables = description(definition)
        typer.echo(f"{definition.id}: {definition.summary}\n")
    for table in tables:
        if markdown:
            heading = f"**{table.title}**\n\n" if task else ""
            typer.echo(f"{heading}{table.markdown}\n")
        else:
            console.print(table.shown)
