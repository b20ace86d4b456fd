"""Training with several seeds: one after the other in this process, or by a team of processes or of machines.

A seed is one piece of work and one run folder, so that what was stopped goes on where it was, seed by seed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from dq_marine.agents.seeds.one_seed import take_over, train_seed, train_seed_anywhere
from dq_marine.agents.seeds.results import SeedResult, result_of
from dq_marine.agents.seeds.seeds_folder import SeedsFolder
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.beginning import check_can_begin
from dq_marine.agents.training.run_folder import LARGEST_SEED
from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.side_by_side import Team

FAILURES = (InvalidInputError, ValueError, ArithmeticError)
"""Of one seed, after which the others go on: numbers that are not finite, a folder that cannot be written."""

GLANCE = 2.0
"""Between two looks at how far the runs are [s]."""

Failures = dict[int, str]
"""What went wrong, by the seed."""

Way = Callable[[SeedsFolder, str, TrainingSettings, Sequence[int], Console], Failures]
"""(folder, its mark, settings, seeds, console) -> what failed: how seeds are trained."""


def train_seeds(
    folder: SeedsFolder,
    settings: TrainingSettings,
    seeds: range,
    *,
    way: Way,
    force: bool = False,
    console: Console,
) -> list[SeedResult]:
    """Train each seed to its end, and return how they ended, in their order; those that ended before are kept.

    Args:
        folder: new, or of the same training, with other seeds or fewer.
        settings: what to learn, where and how.
        seeds: at least one, each at most 2^32 - 1.
        way: how they are trained: `one_after_the_other` or `by_team`.
        force: train all of them anew.
        console: to tell progress on.

    Raises:
        InvalidInputError: there are no seeds or one is too large, another training is in the folder, the environment
            cannot be made, or, once all others have ended, a seed failed.
        MissingDependencyError: a library that learns is not installed.
    """
    whole_number("seeds", len(seeds), least=1)
    for end in (seeds[0], seeds[-1]):
        whole_number("seed", end, least=0, most=LARGEST_SEED)
    check_can_begin(settings)  # so that a mistake leaves an earlier training untouched
    with folder.begun(settings, force=force) as mark:
        missing = [seed for seed in seeds if not folder.is_finished(seed, settings)]
        failures = way(folder, mark, settings, missing, console) if missing else {}
        if failures:
            told = "; ".join(f"seed {seed}: {what}" for seed, what in sorted(failures.items()))
            raise InvalidInputError(
                f"{len(failures)} of {len(seeds)} seeds failed, and the others are kept: {told}; the same command "
                "tries them again"
            )
        return [result_of(folder.run(seed), seed) for seed in seeds]


def one_after_the_other(
    folder: SeedsFolder, mark: str, settings: TrainingSettings, seeds: Sequence[int], console: Console
) -> Failures:
    """Train seeds in this process, each behind a progress bar of its own."""
    failures: Failures = {}
    for seed in seeds:
        console.print(f"Seed {seed}, in {folder.run(seed).path}", soft_wrap=True)
        try:
            train_seed(folder.run(seed), settings, seed, console)
        except FAILURES as error:
            failures[seed] = str(error)
    return failures


def by_team(team: Team) -> Way:
    """Return the way that gives each seed to one of a team."""

    def way(
        folder: SeedsFolder, mark: str, settings: TrainingSettings, seeds: Sequence[int], console: Console
    ) -> Failures:
        path = folder.path.resolve()
        with _progress_bar(console) as bar, team(len(seeds)) as pool:
            shown = bar.add_task(
                settings.algorithm.name.upper(), total=len(seeds), completed=0, learned="0 %"
            )
            runs = {pool.submit(train_seed_anywhere, path, mark, settings, seed): seed for seed in seeds}
            return _gathered(folder, settings, runs, bar, shown)

    return way


def _gathered(
    folder: SeedsFolder,
    settings: TrainingSettings,
    runs: dict[Future[Any], int],
    bar: Progress,
    shown: TaskID,
) -> Failures:
    """Wait for runs, put those that come from machines that do not see the folder in their places, tell how it goes."""
    failures: Failures = {}
    waiting, ended = set(runs), 0
    while waiting:
        done, waiting = wait(waiting, timeout=GLANCE, return_when=FIRST_COMPLETED)
        for one in done:
            try:
                packed = one.result()
            except BrokenProcessPool as error:
                raise InvalidInputError(
                    "a process that trained was killed, as where memory runs out; train fewer at a time with "
                    "--processes: the same command goes on where they were"
                ) from error
            except FAILURES as error:
                failures[runs[one]] = str(error)
                continue
            if packed is not None:
                take_over(packed, folder.run(runs[one]))
        ended += len(done)
        share = (ended + sum(_share(folder, settings, runs[one]) for one in waiting)) / len(runs)
        bar.update(shown, completed=ended, learned=f"{share:.0%}")
    return failures


def _share(folder: SeedsFolder, settings: TrainingSettings, seed: int) -> float:
    """Return how much of a run was learned by its latest checkpoint; nothing where this machine sees none."""
    return min(folder.run(seed).progress("checkpoints").timesteps / settings.timesteps, 1.0)


def _progress_bar(console: Console) -> Progress:
    return Progress(
        TextColumn("[bold]{task.description}"),
        BarColumn(bar_width=20),
        MofNCompleteColumn(),
        TextColumn("seeds, {task.fields[learned]} of all timesteps"),
        TimeElapsedColumn(),
        console=console,
    )
