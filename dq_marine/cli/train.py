"""The command `dq-marine train`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples
from dq_marine.cli.options import (
    AddressOption,
    AlgorithmOption,
    CurrentOption,
    DistributedOption,
    EnvsOption,
    LevelOption,
    PerturbOption,
    PrintPresetOption,
    ProcessesOption,
    SetOption,
    TaskOption,
    TrainingPresetOption,
    VehicleOption,
    print_preset,
)
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.agents.settings import TrainingSettings
    from dq_marine.agents.training.run_folder import RunFolder

EXAMPLES = examples(
    "dq-marine train --run runs/ppo",
    "dq-marine train --run runs/ppo --resume",
    "dq-marine train --run runs/sac --algorithm sac --seed 1",
    "dq-marine train --run runs/five --seeds 5 --processes 2",
    "dq-marine train --run runs/many --seeds 20 --distributed --address 10.0.0.1:6379",
    "dq-marine train --run runs/waypoints --preset WaypointTracking --algorithm tqc",
    "dq-marine train --run runs/memory --algorithm recurrent_ppo",
    "dq-marine train --run runs/docking --task Docking --imitate controller",
    "dq-marine train --run runs/lessons --task Docking --level medium --curriculum easy",
    "dq-marine train --run runs/many --set randomise=default --set sensors=auv",
    "dq-marine train --run runs/critic --set randomise=default --privileged-critic current",
    "dq-marine train --run runs/calm --set current=0.1 --set reward.effort=0.05",
    "dq-marine train --print-preset --set actuation=thrusters > my_preset.toml",
    "dq-marine train --run runs/mine --preset my_preset.toml --vehicle my_vehicle.toml",
    "tensorboard --logdir runs",
)


def train(
    run: Annotated[
        Path | None,
        typer.Option(
            "--run", help="Folder for checkpoints, the best model and logs.", show_default="required"
        ),
    ] = None,
    algorithm: AlgorithmOption = None,
    preset: TrainingPresetOption = None,
    timesteps: Annotated[
        int | None,
        typer.Option(
            "--timesteps", min=1, help="Steps in all, also with --resume.", show_default="the preset's"
        ),
    ] = None,
    envs: EnvsOption = None,
    imitate: Annotated[
        str | None,
        typer.Option(
            "--imitate",
            metavar="BASELINE",
            help="Begin as a copy of controller, lqr or mpc, and learn from there; how, [imitation] in a preset says.",
            show_default="none, or the preset's",
        ),
    ] = None,
    curriculum: Annotated[
        list[str] | None,
        typer.Option(
            "--curriculum",
            metavar="LEVEL",
            help="Learn at this level until most episodes succeed, then at --level; may be repeated, easiest first. "
            "When a level is learned, [curriculum] in a preset says.",
            show_default="none, or the preset's",
        ),
    ] = None,
    privileged_critic: Annotated[
        list[str] | None,
        typer.Option(
            "--privileged-critic",
            metavar="PART",
            help="Let the critic, not the policy, see what only the simulator knows: current, vehicle (in what it is "
            "not the nominal one), truth (behind sensors and delays); may be repeated.",
            show_default="none, or the preset's",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", min=0, help="Seed of networks, starts and currents, at most 2^32 - 1.", show_default="0"
        ),
    ] = None,
    seeds: Annotated[
        int | None,
        typer.Option(
            "--seeds",
            min=1,
            max=10_000,
            metavar="N",
            help="Train with N seeds, from --seed on, each in a run folder of its own inside --run. The same command "
            "goes on where it was stopped, and with a larger N adds to it.",
            show_default="one run, in --run itself",
        ),
    ] = None,
    processes: ProcessesOption = None,
    distributed: DistributedOption = False,
    address: AddressOption = None,
    task: TaskOption = None,
    vehicle: VehicleOption = None,
    level: LevelOption = None,
    current: CurrentOption = None,
    perturb: PerturbOption = None,
    set_: SetOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue from the run's latest checkpoint.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the run in the folder.")] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Open a page that follows one of the environments.")
    ] = False,
    only_print: PrintPresetOption = False,
) -> None:
    """Train an agent with one of six algorithms. A run that was interrupted can be resumed.

    TensorBoard shows returns, what the learner reports, and of each episode the metrics at its end (episode_end/...),
    and the sums of its reward terms (episode_reward/...); of evaluations the same (eval/...).

    What one seed learned another may not: --seeds trains several, side by side or with --distributed on a cluster, and
    shows how each ended, their mean, and how many learned the task.
    """
    from dq_marine.agents.training.run_folder import RunFolder
    from dq_marine.cli.agent_options import EnvironmentOptions, requested_training
    from dq_marine.cli.seeds import requested_way, train_several

    if run is None and (resume or not only_print):
        raise typer.BadParameter("name a folder for the run, as in --run runs/ppo", param_hint="--run")
    spread = {"processes": processes, "distributed": distributed, "address": address}
    if seeds is None:
        _refuse("needs --seeds, too: it says who trains when there are several", **spread)
    else:
        _refuse(
            "cannot go with --seeds: the same command goes on where it was, and what to follow is one run",
            resume=resume,
            watch=watch,
        )
    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    if resume:
        _refuse(
            "cannot go with --resume: a run goes on as it was begun; leave it out, or train in another folder",
            algorithm=algorithm,
            preset=preset,
            envs=envs,
            seed=seed,
            imitate=imitate,
            curriculum=curriculum,
            force=force,
            **{"privileged-critic": privileged_critic},
            **options.given(),
        )
        settings = None
    else:
        settings = requested_training(
            options,
            algorithm=algorithm,
            preset=preset,
            timesteps=timesteps,
            envs=envs,
            teacher=imitate,
            curriculum=curriculum,
            privileged_critic=privileged_critic,
        )
    if run is None or only_print:
        print_preset(settings or RunFolder(run or "").read_plan().settings)
        return
    if settings is not None and seeds is not None:
        way = requested_way(processes, distributed=distributed, address=address)
        train_several(run, settings, range(seed or 0, (seed or 0) + seeds), way=way, force=force)
        return
    _train(RunFolder(run), settings, timesteps=timesteps, seed=seed or 0, force=force, watch=watch)


def _train(
    folder: RunFolder,
    settings: TrainingSettings | None,
    *,
    timesteps: int | None,
    seed: int,
    force: bool,
    watch: bool,
) -> None:
    """Train by settings, or without any go on; then say how it ended."""
    # Only now, after a look at the options: it imports torch, which takes seconds.
    from dq_marine.agents.training import training

    try:
        if settings is None:
            summary = training.resume_training(folder, timesteps=timesteps, console=console, watch=watch)
        else:
            summary = training.begin_training(
                folder, settings, seed=seed, force=force, console=console, watch=watch
            )
    except KeyboardInterrupt:
        done = folder.progress("checkpoints").timesteps
        console.print(
            f"Stopped; {done:,} timesteps are saved. Go on: dq-marine train --run {folder.path} --resume",
            soft_wrap=True,
        )
        raise typer.Exit(130) from None
    console.print(training.summary_table(summary))
    console.print(
        f"Next: dq-marine evaluate --run {folder.path} --agent controller --agent zero", soft_wrap=True
    )


def _refuse(why: str, **options: object) -> None:
    """Refuse options that say nothing here, or contradict others."""
    given = [f"--{name}" for name, value in options.items() if value is not None and value is not False]
    if given:
        raise InvalidInputError(f"{', '.join(given)} {why}")
