"""What `dq-marine train --seeds` does: several runs of one training, and a table of how they ended."""

from __future__ import annotations

from pathlib import Path

import typer

from dq_marine.agents.seeds.results import results_table, write_results
from dq_marine.agents.seeds.seeds_folder import SeedsFolder
from dq_marine.agents.seeds.training import Way, by_team, one_after_the_other, train_seeds
from dq_marine.agents.settings import TrainingSettings
from dq_marine.cli.agent_options import requested_team
from dq_marine.cli.common import console


def requested_way(processes: int | None, *, distributed: bool, address: str | None) -> Way:
    """Return how seeds are trained: in this process where one at a time was asked for, else by a team.

    Raises:
        InvalidInputError: an address is given, and the work is not to be distributed.
    """
    team = requested_team(processes, distributed=distributed, address=address)
    return one_after_the_other if processes == 1 and not distributed else by_team(team)


def train_several(run: Path, settings: TrainingSettings, seeds: range, *, way: Way, force: bool) -> None:
    """Train every seed, and say how they ended.

    Raises:
        InvalidInputError: see `train_seeds`.
    """
    folder = SeedsFolder(run)
    try:
        results = train_seeds(folder, settings, seeds, way=way, force=force, console=console)
    except KeyboardInterrupt:
        console.print(
            f"Stopped; what was learned is kept in {folder.path}. Go on with the same command.",
            soft_wrap=True,
        )
        raise typer.Exit(130) from None
    write_results(folder.results, results)
    console.print(results_table(settings, results))
    console.print(f"Wrote {folder.results}", soft_wrap=True)
    best = folder.run(max(results, key=lambda one: one.mean_return).seed)
    console.print(
        f"Next: dq-marine evaluate --run {best.path} --agent controller --agent zero", soft_wrap=True
    )
