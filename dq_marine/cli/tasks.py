"""The command `dq-marine tasks`: the registered tasks, and what each consists of."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples

if TYPE_CHECKING:
    from dq_marine.cli.task_tables import TextTable

EXAMPLES = examples(
    "dq-marine tasks",
    "dq-marine tasks StationKeeping",
    "dq-marine tasks --markdown",
    "dq-marine tasks --pages docs/tasks",
    "dq-marine tasks --pages docs/tasks --pictures",
)


def tasks(
    task: Annotated[
        str | None, typer.Argument(help="Id or name of a task.", show_default="all, in one table")
    ] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="Tables as Markdown.")] = False,
    pages: Annotated[
        Path | None,
        typer.Option(
            "--pages",
            help="Write a page for each task, and an index, into this folder, with the figures of leaderboard.json if "
            "that is beside the folder.",
        ),
    ] = None,
    pictures: Annotated[
        bool,
        typer.Option("--pictures", help="With --pages: draw a picture for each, which needs a Chromium."),
    ] = False,
) -> None:
    """List the tasks; or show a task's action, observation, reward, metrics and keywords; or write pages of all."""
    from dq_marine.cli.task_tables import description, task_table
    from dq_marine.envs.core.registry import task_called
    from dq_marine.errors import InvalidInputError

    if pages is not None:
        if task is not None:
            raise InvalidInputError(f"--pages {pages} writes the pages of all tasks; leave {task} out")
        _write_pages(pages, pictures)
        return
    if pictures:
        raise InvalidInputError("--pictures draws the pictures of pages; give --pages FOLDER, too")
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


def _write_pages(folder: Path, pictures: bool) -> None:
    """Write the pages of all tasks, and their pictures if they are asked for; the folder's other files stay."""
    from dq_marine.cli.task_pages import LEADERBOARD, picture_name, task_pages
    from dq_marine.envs.core.registry import shipped_tasks
    from dq_marine.envs.scenarios.files import scenarios_of
    from dq_marine.util.files import with_folder, write_whole

    for name, text in task_pages(folder.resolve().parent / LEADERBOARD).items():
        write_whole(with_folder(folder / name), text)
        console.print(f"Wrote {folder / name}", soft_wrap=True)
    for task in shipped_tasks() if pictures else ():
        from dq_marine.agents.evaluation.picture import scenario_picture

        for scenario in scenarios_of(task.id)[:1]:
            path = folder / picture_name(task)
            write_whole(path, scenario_picture(scenario))
            console.print(f"Wrote {path}, of {scenario.full_name}", soft_wrap=True)
