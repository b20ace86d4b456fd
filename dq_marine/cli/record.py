"""The command `dq-marine record`: what agents fly, as Minari datasets."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.checks import finite_number
from dq_marine.cli.common import console, examples, shown_part
from dq_marine.cli.options import (
    Baseline,
    CurrentOption,
    EnvironmentPresetOption,
    LevelOption,
    PerturbOption,
    PoliciesOption,
    RunsOption,
    SetOption,
    TaskOption,
    VehicleOption,
    baselines_option,
)

if TYPE_CHECKING:
    from dq_marine.agents.evaluation.episodes import Episode

EXAMPLES = examples(
    "dq-marine record flights --task Docking --level medium --episodes 200 --noise 0.2",
    "dq-marine record flights --task Docking --level medium --agent controller --agent random",
    "dq-marine record flights --policy StationKeeping --episodes 1000",
    "dq-marine fly --teleop --record flights",
)


def record(
    folder: Annotated[Path, typer.Argument(help="Folder of Minari's datasets, made if there is none.")],
    agent: Annotated[
        list[Baseline] | None, baselines_option("controller, if neither --run nor --policy is given")
    ] = None,
    run: RunsOption = None,
    policy: PoliciesOption = None,
    episodes: Annotated[
        int, typer.Option("--episodes", min=1, help="Number of episodes of each agent.")
    ] = 100,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Seed of the first episode; the others count up from it.")
    ] = 0,
    noise: Annotated[
        float,
        typer.Option(
            "--noise",
            min=0.0,
            help="Standard deviation of what is added to actions, which are between -1 and 1: data with it tell what "
            "actions other than the agent's lead to.",
        ),
    ] = 0.0,
    preset: EnvironmentPresetOption = None,
    task: TaskOption = None,
    vehicle: VehicleOption = None,
    level: LevelOption = None,
    current: CurrentOption = None,
    perturb: PerturbOption = None,
    set_: SetOption = None,
) -> None:
    """Record what baselines and policies fly as Minari datasets, to learn from offline; needs the extra `interop`.

    Each agent flies the same seeded episodes and gets a dataset of its own, called by task, vehicle and agent. What you
    fly yourself is recorded by `dq-marine fly --teleop --record FOLDER`. Where it is interrupted, what was flown until
    then is kept.
    """
    from dq_marine.agents.choice import make_agents
    from dq_marine.agents.datasets.dataset_folder import DatasetFolder
    from dq_marine.agents.datasets.recorded_agents import record_agents
    from dq_marine.agents.environments import make_environment
    from dq_marine.agents.evaluation.evaluation import score_table
    from dq_marine.cli.agent_options import EnvironmentOptions, requested_environment, requested_policies

    noise = finite_number("--noise", noise, least=0.0)
    runs = [*(run or []), *requested_policies(policy or [])]
    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    env = make_environment(requested_environment(runs, options, preset=preset))
    agents = make_agents(agent or ([] if runs else [Baseline("controller")]), runs, env, seed=seed)
    flown, planned = 0, episodes * len(agents)
    with DatasetFolder(folder) as datasets, shown_part("Recording") as show:

        def advance(name: str, episode: Episode) -> None:
            nonlocal flown
            flown += 1
            show(flown / planned)

        try:
            scores = record_agents(
                env, agents, datasets, episodes=episodes, seed=seed, noise=noise, after_episode=advance
            )
        finally:
            _tell(folder, datasets.written)
    console.print(score_table(scores))


def _tell(folder: Path, written: dict[str, int]) -> None:
    """Say what was written, and how it is found."""
    from dq_marine.agents.datasets.dataset_folder import FOLDER_VARIABLE

    for name, episodes in written.items():
        console.print(f"Wrote {folder}: dataset {name}, episodes: {episodes}", soft_wrap=True)
        console.print(
            f'With {FOLDER_VARIABLE}={folder}, minari.load_dataset("{name}") finds it.', soft_wrap=True
        )
