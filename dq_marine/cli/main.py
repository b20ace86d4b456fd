"""The command line, `dq-marine`: the commands stand in files of their names.

Everything heavy is imported inside the commands, so that `dq-marine --help` answers at once and needs nothing
beyond the core.
"""

from __future__ import annotations

from typing import Annotated

import typer

from dq_marine import __version__
from dq_marine.cli import (
    add,
    compare,
    demo,
    evaluate,
    export,
    fly,
    leaderboard,
    record,
    report,
    scenarios,
    sea,
    share,
    tasks,
    train,
    tune,
    validate,
)
from dq_marine.cli.common import HELP_OPTIONS, Commands, console
from dq_marine.cli.manoeuvre import app as manoeuvre_app
from dq_marine.cli.vehicles import app as vehicles_app

app = typer.Typer(
    cls=Commands,
    name="dq-marine",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings=HELP_OPTIONS,
)


def _show_version(asked: bool) -> None:
    if asked:
        console.print(f"dq-marine {__version__}", highlight=False)
        raise typer.Exit


@app.callback(epilog="Start here:  [bold]dq-marine demo[/bold]")
def main(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Marine vehicles on a dual quaternion variational integrator: fly, train, evaluate."""


app.command(epilog=demo.EXAMPLES)(demo.demo)
app.command(epilog=fly.EXAMPLES)(fly.fly)
app.command(epilog=evaluate.EXAMPLES)(evaluate.evaluate)
app.command(epilog=compare.EXAMPLES)(compare.compare)
app.command(epilog=leaderboard.EXAMPLES)(leaderboard.leaderboard)
app.command(epilog=record.EXAMPLES)(record.record)
app.command(epilog=train.EXAMPLES)(train.train)
app.command(epilog=tune.EXAMPLES)(tune.tune)
app.command(epilog=export.EXAMPLES)(export.export)
app.command(epilog=share.EXAMPLES)(share.share)
app.command(epilog=tasks.EXAMPLES)(tasks.tasks)
app.command(epilog=scenarios.EXAMPLES)(scenarios.scenarios)
app.add_typer(vehicles_app, name="vehicles")
app.add_typer(manoeuvre_app, name="manoeuvre")
app.command(epilog=validate.EXAMPLES)(validate.validate)
app.command(epilog=sea.EXAMPLES)(sea.sea)
app.command(epilog=report.EXAMPLES)(report.report)
app.command(epilog=add.EXAMPLES)(add.add)
