"""The command `dq-marine scenarios`: episodes that can be repeated, by name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples

if TYPE_CHECKING:
    from dq_marine.cli.task_tables import TextTable
    from dq_marine.envs.scenarios.model import Scenario

EXAMPLES = examples(
    "dq-marine scenarios",
    "dq-marine scenarios StationKeeping",
    "dq-marine scenarios StationKeeping/cross_current",
    "dq-marine scenarios StationKeeping/cross_current --export my_scenario.toml",
    "dq-marine fly --scenario my_scenario.toml",
)


def scenarios(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[TASK|SCENARIO]",
            help="Name of a task, for its scenarios; or name or file of a scenario, for what it says.",
            show_default="all tasks",
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option("--export", help="Write the scenario into this file, to start one's own from (.toml)."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace that file if it exists.")] = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Tables as Markdown.")] = False,
) -> None:
    """List the scenarios: episodes that can be repeated, each with its start, currents, sensors and seed.

    A scenario is a table of a TOML file. What it says of `gym.make` stands under keywords, what it says of `reset`
    under reset, and the seed fixes what is left. In Python: dq_marine.make_scenario("StationKeeping/cross_current").
    """
    from dq_marine.cli.task_tables import scenario_conditions_table, scenario_count_table, scenario_table
    from dq_marine.envs.core.registry import full_id, registered_tasks, task_named
    from dq_marine.envs.scenarios.files import load_scenario
    from dq_marine.errors import InvalidInputError

    tasks = {one.id for one in registered_tasks()}
    if name is not None and full_id(name) not in tasks:
        _show(load_scenario(name), export, force)
        return
    if export is not None:
        raise InvalidInputError(f"--export {export} writes one scenario; name it, as in StationKeeping/calm")
    if name is None:
        table: TextTable = scenario_count_table()
    else:
        of_task = scenario_conditions_table if markdown else scenario_table
        table = of_task(task_named(full_id(name)))
    if markdown:
        typer.echo(table.markdown)
    else:
        console.print(table.shown)


def _show(scenario: Scenario, export: Path | None, force: bool) -> None:
    """Print the scenario's file, or write it."""
    from dq_marine.util.files import check_ending, check_folder, check_targets, write_whole

    if export is None:
        typer.echo(scenario.toml, nl=False)
        return
    check_ending(export, ".toml")
    check_folder(export)
    check_targets([export], force=force)
    write_whole(export, scenario.toml)
    console.print(f"Wrote {export}; `dq-marine fly --scenario {export}` flies it", soft_wrap=True)
