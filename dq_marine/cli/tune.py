"""The command `dq-marine tune`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dq_marine.cli.common import console, examples
from dq_marine.cli.options import (
    AddressOption,
    AlgorithmOption,
    CurrentOption,
    DistributedOption,
    EnvsOption,
    LevelOption,
    PerturbOption,
    ProcessesOption,
    SetOption,
    TaskOption,
    TrainingPresetOption,
    VehicleOption,
)

if TYPE_CHECKING:
    from dq_marine.agents.tuning.study import Tried

EXAMPLES = examples(
    "dq-marine tune --out studies/station --trials 30 --timesteps 300000",
    "dq-marine tune --out studies/docking --task Docking --level easy --algorithm sac --processes 2",
    "dq-marine tune --out studies/docking --task Docking --trials 200 --distributed --address 10.0.0.1:6379",
    "dq-marine train --run runs/tuned --preset studies/docking/preset.toml --seed 1",
)

SHOWN = 5
"""Of the trials, in the table at the end."""


def tune(
    out: Annotated[
        Path,
        typer.Option(
            "--out", help="Folder of the study; one that is there goes on.", show_default="required"
        ),
    ],
    trials: Annotated[int, typer.Option("--trials", min=1, help="In all, with those of before.")] = 30,
    algorithm: AlgorithmOption = None,
    preset: TrainingPresetOption = None,
    timesteps: Annotated[
        int | None, typer.Option("--timesteps", min=1, help="Of each trial.", show_default="the preset's")
    ] = None,
    envs: EnvsOption = None,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Of all trials, and of how they are chosen.")
    ] = 0,
    processes: ProcessesOption = None,
    distributed: DistributedOption = False,
    address: AddressOption = None,
    task: TaskOption = None,
    vehicle: VehicleOption = None,
    level: LevelOption = None,
    current: CurrentOption = None,
    perturb: PerturbOption = None,
    set_: SetOption = None,
) -> None:
    """Search for the hyperparameters with which an algorithm learns a task best.

    The first trial is the preset as it is; the others are proposed by Optuna, and given up early where they are worse
    than the median. The folder gets the best as a preset, all trials as a table and as a picture, and the study, which
    a stopped search goes on from: give the same command again, with more trials if you like.

    With --distributed a trial is a task of Ray's. The study stays here, in SQLite, and other machines need not see it:
    a trial asks after each evaluation whether to give up. --processes says how many train at a time on one machine, and
    with --address, at most.
    """
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from dq_marine.agents.tuning.cluster_trials import on_cluster
    from dq_marine.agents.tuning.results import write_results
    from dq_marine.agents.tuning.study_folder import StudyFolder
    from dq_marine.agents.tuning.tuning import plan_of
    from dq_marine.agents.tuning.tuning import tune as search
    from dq_marine.backend.workers import usable_cores
    from dq_marine.cli.agent_options import EnvironmentOptions, requested_cluster, requested_training

    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    settings = requested_training(options, algorithm=algorithm, preset=preset, timesteps=timesteps, envs=envs)
    cluster = requested_cluster(processes, distributed=distributed, address=address)
    folder, plan = StudyFolder(out), plan_of(settings, seed=seed)
    way = None if cluster is None else on_cluster(cluster, processes)
    columns = (
        TextColumn("[bold]{task.description}"),
        BarColumn(bar_width=20),
        MofNCompleteColumn(),
        TextColumn("trials"),
        TimeElapsedColumn(),
        TextColumn("best {task.fields[best]}"),
    )
    with Progress(*columns, console=console) as bar:
        going = bar.add_task(settings.algorithm.name.upper(), total=trials, best="-")

        def after(tried: list[Tried]) -> None:
            best = tried[0].mean_return if tried else None
            bar.update(going, completed=len(tried), best="-" if best is None else f"{best:.1f}")

        try:
            found = search(
                folder, plan, trials=trials, processes=processes or usable_cores(), way=way, after=after
            )
        except KeyboardInterrupt:
            bar.stop()
            console.print(
                f"Stopped; what was tried is kept in {folder.path}. Go on with the same command.",
                soft_wrap=True,
            )
            raise typer.Exit(130) from None
    written = write_results(folder, plan, found)
    console.print(_table(found))
    console.print(f"Wrote {', '.join(map(str, written))}", soft_wrap=True)
    if folder.preset in written:
        console.print(
            f"Next: dq-marine train --run runs/tuned --preset {folder.preset} --seed {seed + 1}",
            soft_wrap=True,
        )


def _table(found: list[Tried]) -> Table:
    """Return the best trials as a table."""
    table = Table(title=f"The best of {len(found)} trials")
    for heading in ("trial", "mean return", "timesteps"):
        table.add_column(heading, justify="right")
    table.add_column("")
    for one in found[:SHOWN]:
        mean = "-" if one.mean_return is None else f"{one.mean_return:.1f}"
        state = "failed" if one.mean_return is None else "given up" if one.given_up else ""
        what = ", ".join(part for part in ("the preset as it is" if one.number == 0 else "", state) if part)
        table.add_row(str(one.number), mean, f"{one.timesteps:,}", what)
    return table
