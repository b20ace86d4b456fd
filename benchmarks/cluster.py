"""Measure what work on a cluster costs beside the work itself, and predict how long campaigns take with more cores.

Run: python benchmarks/cluster.py [--timesteps N] [--repeats N]

Begins a cluster of one core on this machine, measures on it, and prints the constants and the table of
docs/howto/cluster.md. Times of work are processor time, so that they hold beside other work, too; the others are the
shortest of some repeats.
"""

from __future__ import annotations

import argparse
import io
import math
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from rich.console import Console
from suite.tables import table

from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.shared_evaluation import EPISODES_OF_A_SHARE, Share, fly_share
from dq_marine.report.machine import commit, cpu_model, load, versions
from dq_marine.util.cluster import cluster_workers

CORES = (1, 10, 100, 1000)
EMPTY = 1000
MEGABYTES = 20
SHARE = Share(DEFAULT_ENVIRONMENT, "controller", None, 0, range(EPISODES_OF_A_SHARE), False)


class Constants(NamedTuple):
    """What was measured [s].

    Attributes:
        begin: a cluster of this machine's own.
        worker: the process of a worker, and what flying imports and loads there, compiled before.
        compiling: what that takes longer where nothing is compiled yet.
        learner: the imports of a worker that trains, torch among them, and its first few thousand timesteps.
        handing: an empty task, from one caller that has many.
        megabyte: of a result, from a worker on the same machine.
        share: processor time of some episodes of station keeping by the baseline controller.
        training: processor time of a training by the preset `ppo`, of all its timesteps.
    """

    begin: float
    worker: float
    compiling: float
    learner: float
    handing: float
    megabyte: float
    share: float
    training: float


class Campaign(NamedTuple):
    """Work in equal pieces: what it is, how many, processor time of each and start-up of a worker [s]."""

    what: str
    pieces: int
    each: float
    worker: float


def wall(one: Campaign, constants: Constants, cores: int) -> float:
    """Return how long a campaign takes [s]: it begins, then rounds of pieces, or what one caller can hand out."""
    rounds = math.ceil(one.pieces / cores) * one.each
    return constants.begin + one.worker + constants.compiling + max(rounds, one.pieces * constants.handing)


def timed(call: Callable[[], Any]) -> float:
    """Return how long a call takes [s]."""
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def processor_time(function: Callable[..., Any], *arguments: Any) -> float:
    """Return the processor time of a call, of all threads of its process [s]."""
    began = time.process_time()
    function(*arguments)
    return time.process_time() - began


def trained(timesteps: int) -> None:
    """Train by the preset `ppo`, for some timesteps."""
    from dq_marine.agents.training.run_folder import RunFolder
    from dq_marine.agents.training.training import begin_training

    settings = read_settings("ppo", TrainingSettings).model_copy(update={"timesteps": timesteps})
    with tempfile.TemporaryDirectory() as scratch:
        begin_training(RunFolder(Path(scratch) / "run"), settings, console=Console(file=io.StringIO()))


def start_up(cache: Path | None) -> tuple[float, float]:
    """Return how long a cluster takes to begin, and its worker to fly a first share, beyond another one [s]."""
    before = os.environ.get("DQ_MARINE_CACHE_DIR")
    if cache is not None:
        os.environ["DQ_MARINE_CACHE_DIR"] = str(cache)
    try:
        began = time.perf_counter()
        with cluster_workers(None, 1) as pool:
            begin = time.perf_counter() - began
            first, second = (timed(pool.submit(fly_share, SHARE).result) for _ in range(2))
    finally:
        if before is not None:
            os.environ["DQ_MARINE_CACHE_DIR"] = before
        else:
            os.environ.pop("DQ_MARINE_CACHE_DIR", None)
    return begin, first - second


def measured(timesteps: int, repeats: int) -> Constants:
    """Return the constants of this machine."""
    fly_share(SHARE)  # compiled and kept
    starts = [start_up(None) for _ in range(repeats)]
    worker = min(worker for _, worker in starts)
    with tempfile.TemporaryDirectory() as cache:
        compiled = start_up(Path(cache))[1]
    with cluster_workers(None, 1) as pool:

        def processor(function: Callable[..., Any], *arguments: Any) -> float:
            spent: float = pool.submit(processor_time, function, *arguments).result()
            return spent

        processor(fly_share, SHARE)
        share = median(processor(fly_share, SHARE) for _ in range(repeats))
        handing = min(
            timed(lambda: [one.result() for one in [pool.submit(abs, 1) for _ in range(EMPTY)]]) / EMPTY
            for _ in range(repeats)
        )
        megabyte = min(
            timed(pool.submit(bytes, MEGABYTES * 10**6).result) / MEGABYTES for _ in range(repeats)
        )
        learner = processor(trained, 1)
        once, more = processor(trained, timesteps), processor(trained, 3 * timesteps)
    whole = read_settings("ppo", TrainingSettings).timesteps
    each = once + (more - once) / (2 * timesteps) * (whole - timesteps)
    return Constants(
        begin=min(begin for begin, _ in starts),
        worker=worker,
        compiling=max(compiled - worker, 0.0),
        learner=learner,
        handing=handing,
        megabyte=megabyte,
        share=share,
        training=each,
    )


def page(constants: Constants) -> str:
    """Return what stands in docs/howto/cluster.md."""
    found = ", ".join(f"{name} {number}" for name, number in versions(("ray", "numba", "torch")).items())
    at = commit("dq_marine", "envs", "agents")
    told = (
        f"Measured by `python benchmarks/cluster.py` on one core of {cpu_model()}, {found}, commit {at}, beside other "
        f"work (load average {load()})."
    )
    lines = [
        told,
        "",
        table(("constant", "[s]"), [(name, f"{value:.3g}") for name, value in constants._asdict().items()]),
        "",
    ]
    campaigns = (
        Campaign("100,000 episodes of station keeping", 10_000, constants.share, constants.worker),
        Campaign(
            "1,000 seeds or trials of 2 million timesteps",
            1_000,
            constants.training,
            constants.worker + constants.learner,
        ),
    )
    rows = []
    for one in campaigns:
        alone = wall(one, constants, 1)
        for cores in CORES:
            seconds = wall(one, constants, cores)
            rows.append(
                (
                    one.what,
                    f"{cores:,}",
                    duration(seconds),
                    f"{alone / seconds:,.0f}",
                    f"{seconds * cores / 3600:,.1f}",
                )
            )
    header = ("campaign", "cores", "wall", "times as fast as one core", "core hours paid")
    return "\n".join([*lines, table(header, rows)])


def duration(seconds: float) -> str:
    """Return a time as people read it."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.0f} s"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--timesteps", type=int, default=100_000, help="of the shorter of two trainings")
    parser.add_argument("--repeats", type=int, default=3, help="of what is measured several times")
    arguments = parser.parse_args()
    print(page(measured(arguments.timesteps, arguments.repeats)))


if __name__ == "__main__":
    main()
