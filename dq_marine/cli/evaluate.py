"""The command `dq-marine evaluate`: agents over the same episodes."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dq_marine.cli.common import console, examples
from dq_marine.cli.options import (
    AddressOption,
    Baseline,
    CurrentOption,
    DistributedOption,
    EnvironmentPresetOption,
    LevelOption,
    PerturbOption,
    PoliciesOption,
    PrintPresetOption,
    RunsOption,
    SetOption,
    TaskOption,
    VehicleOption,
    baselines_option,
    print_preset,
)
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.agents.evaluation.episodes import Episode
    from dq_marine.agents.evaluation.evaluation import Score
    from dq_marine.agents.settings import EnvironmentSettings

EXAMPLES = examples(
    "dq-marine evaluate",
    "dq-marine evaluate --run runs/ppo --agent controller --agent zero --episodes 100",
    "dq-marine evaluate --run runs/ppo --set current=0.5",
    "dq-marine evaluate --run runs/ppo --agent controller --perturb payload --perturb late_actions",
    "dq-marine evaluate --task TrajectoryTracking --agent mpc --episodes 1000 --processes 8",
    "dq-marine evaluate --policy policy.onnx --agent controller",
    "dq-marine evaluate --scenario StationKeeping/strong_current --scenario StationKeeping/failed_dvl",
    "dq-marine evaluate --scenario Encounter --agent controller --json imazu.json",
    "dq-marine evaluate --agent controller --set control_period=0.2 --set reward.effort=0.1",
    "dq-marine evaluate --run runs/ppo --episodes 10 --trajectories flights --format parquet",
)


class Format(StrEnum):
    """What `--format` takes."""

    CSV = "csv"
    PARQUET = "parquet"


def evaluate(
    agent: Annotated[
        list[Baseline] | None,
        baselines_option("controller, zero and random, if neither --run nor --policy is given"),
    ] = None,
    run: RunsOption = None,
    policy: PoliciesOption = None,
    episodes: Annotated[
        int | None,
        typer.Option(
            "--episodes",
            min=1,
            help="Number of episodes of each agent.",
            show_default="50, or in a scenario 1",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed",
            min=0,
            help="Seed of the first episode; the others count up from it.",
            show_default="0, or a scenario's own",
        ),
    ] = None,
    scenario: Annotated[
        list[str] | None,
        typer.Option(
            "--scenario",
            help="Name or file of a scenario, or name of a task, for all of its scenarios; may be repeated. "
            "`dq-marine scenarios` lists them.",
        ),
    ] = None,
    preset: EnvironmentPresetOption = None,
    task: TaskOption = None,
    vehicle: VehicleOption = None,
    level: LevelOption = None,
    current: CurrentOption = None,
    perturb: PerturbOption = None,
    set_: SetOption = None,
    json: Annotated[Path | None, typer.Option("--json", help="Write the scores into this file, too.")] = None,
    trajectories: Annotated[
        Path | None,
        typer.Option(
            "--trajectories", help="Write a file for each episode, AGENT_SEED.csv, into this folder."
        ),
    ] = None,
    form: Annotated[Format, typer.Option("--format", help="Format of these files.")] = Format.CSV,
    processes: Annotated[
        int | None,
        typer.Option(
            "--processes", min=1, max=256, help="How many fly at a time.", show_default="this one alone"
        ),
    ] = None,
    distributed: DistributedOption = False,
    address: AddressOption = None,
    only_print: PrintPresetOption = False,
) -> None:
    """Compare agents over the same seeded episodes: metrics, returns, success; or in scenarios.

    A run is evaluated in what it was trained in, or where an option says so, under other conditions: the table says
    which. A scenario is an episode that can be repeated: its start, its currents and its seed are fixed.

    Thousands of episodes, or an agent that thinks for long, are flown side by side by --processes or on a cluster by
    --distributed. The scores are the same.
    """
    from dq_marine.agents.choice import make_agents, other_conditions
    from dq_marine.agents.controllers.baselines import BASELINES
    from dq_marine.agents.environments import make_environment
    from dq_marine.agents.evaluation.evaluation import evaluate as evaluate_agents
    from dq_marine.agents.evaluation.evaluation import score_table
    from dq_marine.agents.shared_evaluation import evaluate_by_team
    from dq_marine.cli.agent_options import (
        EnvironmentOptions,
        requested_environment,
        requested_policies,
        requested_team,
    )
    from dq_marine.cli.scenario_scores import Flights, evaluate_scenarios

    runs = [*(run or []), *requested_policies(policy or [])]
    baselines = agent or ([] if runs else [Baseline(name) for name in BASELINES])
    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    team = requested_team(processes, distributed=distributed, address=address)
    alone = processes is None and not distributed
    if scenario:
        if not alone:
            raise InvalidInputError(
                f"--scenario {scenario[0]} is flown by this process; leave --processes and --distributed out, or fly "
                "all scenarios with `dq-marine leaderboard --scenarios`, which takes them"
            )
        flights = Flights(scenario, options, preset, baselines, runs, episodes or 1, seed)
        evaluate_scenarios(
            flights, json, None if trajectories is None else _keeper(trajectories, form), only_print
        )
        return
    episodes, seed = episodes or 50, seed or 0
    environment = requested_environment(runs, options, preset=preset)
    if only_print:
        print_preset(environment, "environment")
        return
    env = make_environment(environment)
    agents = make_agents(baselines, runs, env, seed=seed)
    keep = None if trajectories is None else _keeper(trajectories, form)
    fly = (
        partial(evaluate_agents, env, agents)
        if alone
        else partial(evaluate_by_team, environment, baselines, runs, team=team)
    )
    scores = _evaluated(fly, episodes, len(agents), seed, keep)
    conditions = other_conditions(runs, environment)
    console.print(score_table(scores, _notes(conditions)))
    if json is not None:
        _write_scores(json, environment, seed, scores, conditions)
        console.print(f"Wrote {json}", soft_wrap=True)
    if trajectories is not None:
        console.print(f"Wrote {episodes * len(agents)} trajectories into {trajectories}", soft_wrap=True)


def _evaluated(
    fly: Callable[..., list[Score]], episodes: int, agents: int, seed: int, keep: Any
) -> list[Score]:
    """Evaluate behind a progress bar; `keep` is called with agent and episode, if it is not None."""
    from rich.progress import Progress

    with Progress(console=console, transient=True) as bar:
        shown = bar.add_task("evaluating", total=episodes * agents)

        def advance(name: str, episode: Episode) -> None:
            if keep is not None:
                keep(name, episode)
            bar.update(shown, advance=1, description=f"evaluating {name}")

        return fly(episodes=episodes, seed=seed, after_episode=advance, track=keep is not None)


def _keeper(folder: Path, form: Format) -> Any:
    """Return what writes an episode's trajectory; refuse now what could not be written later."""
    from dq_marine.agents.evaluation.trajectory import check_trajectory_path, made_folder, write_columns

    made_folder(folder)
    check_trajectory_path(folder / f"any.{form}")

    def keep(name: str, episode: Episode) -> None:
        write_columns(episode.columns(), folder / f"{name}_{episode.seed}.{form}")

    return keep


def _notes(conditions: dict[str, dict[str, tuple[Any, Any]]]) -> list[str]:
    """Say under which other conditions than its training's a run was evaluated."""

    def said(value: Any) -> str:
        return "the default" if value is None else f"{value}"

    return [
        f"{name} was trained under other conditions: "
        + ", ".join(
            f"{key} = {said(trained)}, here {said(here)}" for key, (trained, here) in differing.items()
        )
        for name, differing in conditions.items()
    ]


def _write_scores(
    path: Path,
    environment: EnvironmentSettings,
    seed: int,
    scores: list[Score],
    conditions: dict[str, dict[str, tuple[Any, Any]]],
) -> None:
    from dq_marine.util.files import write_json

    differing = {
        run: {key: {"trained": trained, "here": here} for key, (trained, here) in keys.items()}
        for run, keys in conditions.items()
    }
    content = {
        "environment": environment.model_dump(mode="json"),
        "other_conditions": differing,
        "seed": seed,
        "scores": [score.as_dict() for score in scores],
    }
    write_json(path, content)
