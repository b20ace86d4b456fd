"""Section: environments stepped together, over whole episodes."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import no_garbage_collection, rounded
from suite.batch import named
from suite.plan import LEAST, Plan, Section
from suite.tables import find, millions, noise, table

ID = "dq_marine/StationKeeping-v0"
SIZES = (1, 64, 1024, 4096, 16384, 65536)
QUICK_SIZES = (1, 64, 4096)
EPISODE = 300
"""Control periods."""

CHUNKS = 5
"""Samples of each kind at the least."""

REFERENCE_SIZE = 64
KINDS = (("strict", "float64"), ("fast", "float64"), ("fast", "float32"))
GYMNASIUM = "SyncVectorEnv"
SHOWN_SIZE = 4096

METHOD = f"""\
`gym.make_vec("{ID}", num_envs=n, autoreset_mode="SameStep")` with a control period of 0.1 s
in 4 substeps of the full physics, under random actions. The first table is million environment steps (control
periods) per second as a **mean over whole episodes**: over {EPISODE} periods after a common reset, or a multiple. An
episode lasts at most that long, so every environment is reset on the way, most of them because they left their bounds.
Automatic resets, observations, rewards and infos are included. The second table is the **best stretch** of at least
{LEAST * 1e3:.0f} ms, which may have few resets. `{GYMNASIUM}` is Gymnasium's own vectorisation of our single
environment, with {REFERENCE_SIZE} environments.
"""


@dataclass
class Stretch:
    """Environments under way, and how long their steps took.

    Attributes:
        envs: reset.
        actions: to be used in turn.
        periods: steps in a sample.
        samples: seconds a step of all environments.
    """

    envs: VectorEnv[Any, Any, Any]
    actions: list[Any]
    periods: int = 1
    taken: int = 0
    samples: list[float] = field(default_factory=list)

    def run(self, periods: int) -> float:
        """Return how long some steps take."""
        envs, actions = self.envs, self.actions
        start = time.perf_counter()
        for period in range(periods):
            envs.step(actions[period % len(actions)])
        return time.perf_counter() - start

    def prepare(self) -> None:
        """Warm up, find how many steps fill a sample, and begin episodes."""
        self.run(2)
        elapsed = self.run(2) / 2
        self.periods = min(EPISODE, max(1, int(1.3 * LEAST / elapsed)))
        self.envs.reset(seed=0)

    def sample(self) -> None:
        """Take a sample."""
        self.samples.append(self.run(self.periods) / self.periods)
        self.taken += self.periods

    @property
    def finished(self) -> bool:
        """Whether whole episodes have passed, and enough samples were taken."""
        return self.taken >= EPISODE and self.taken % EPISODE < self.periods and len(self.samples) >= CHUNKS


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of an environment's step."""
    rows: list[Row] = []
    for size in plan.pick(SIZES, QUICK_SIZES):
        rows += rows_of_size(plan, size)
    return {"rows": rows}


def rows_of_size(plan: Plan, size: int) -> list[Row]:
    """Return all kinds of environments of one size, measured in turn."""
    actions = random_actions((size, 6))
    stretches: dict[tuple[str, str, int], Stretch] = {}
    for threads in plan.threads:
        for arithmetic, precision in KINDS:
            plan.tell(f"{size:,} environments, {arithmetic} {precision}")
            envs = marine(size, threads=threads, arithmetic=arithmetic, precision=precision)
            stretches[arithmetic, precision, threads] = Stretch(envs, actions)
    if size == REFERENCE_SIZE:
        stretches[GYMNASIUM, "float64", 1] = Stretch(gymnasium_own(size), actions)
    plan.tell(f"{size:,} environments, all in turn")
    run_in_turn(list(stretches.values()), plan.progress)
    rows = [row_of(size, key, stretch) for key, stretch in stretches.items()]
    for stretch in stretches.values():
        stretch.envs.close()
    return rows


def run_in_turn(stretches: list[Stretch], progress: Callable[[float], None]) -> None:
    """Take samples from all, until all have finished."""
    for stretch in stretches:
        stretch.envs.reset(seed=0)
        stretch.prepare()
    with no_garbage_collection():
        unfinished = stretches
        while unfinished:
            for stretch in unfinished:
                stretch.sample()
            unfinished = [stretch for stretch in unfinished if not stretch.finished]
            progress(min(min(1.0, stretch.taken / EPISODE) for stretch in stretches))


def row_of(size: int, key: tuple[str, str, int], stretch: Stretch) -> Row:
    """Return what is recorded, times in nanoseconds a step of one environment."""
    per_step = [sample * 1e9 / size for sample in stretch.samples]
    arithmetic, precision, threads = key
    row: Row = {"environments": size, "arithmetic": arithmetic, "precision": precision, "threads": threads}
    inner = stretch.envs.unwrapped
    if arithmetic != GYMNASIUM:
        row |= {
            "threads_used": inner.threads,
            "bytes_per_environment": rounded(inner.bytes_per_environment),
            "episodes_refused": inner.episodes_refused,
        }
    return row | {
        "periods": stretch.taken,
        "mean_ns": rounded(statistics.fmean(per_step)),
        "best_ns": rounded(min(per_step)),
        "median_ns": rounded(statistics.median(per_step)),
        "samples_ns": [rounded(sample) for sample in per_step],
    }


def marine(size: int, **keywords: Any) -> VectorEnv[Any, Any, Any]:
    """Return our vector environment."""
    return gym.make_vec(ID, num_envs=size, autoreset_mode=AutoresetMode.SAME_STEP, **keywords)


def gymnasium_own(size: int) -> VectorEnv[Any, Any, Any]:
    """Return single environments, one stepped after the other."""
    mode = {"autoreset_mode": AutoresetMode.SAME_STEP}
    return gym.make_vec(ID, num_envs=size, vectorization_mode="sync", vector_kwargs=mode)


def random_actions(shape: tuple[int, ...]) -> list[Any]:
    """Return some actions of a shape."""
    rng = np.random.default_rng(0)
    return [rng.uniform(-1.0, 1.0, shape).astype(np.float32) for _ in range(8)]


def tables(content: dict[str, Any]) -> str:
    """Return rates by size, and the reference."""
    rows = content["rows"]
    parts = [
        f"Million environment steps a second, {words}:\n\n" + rates(rows, which)
        for words, which in (
            ("mean over whole episodes", "mean_ns"),
            ("best stretch", "best_ns"),
        )
    ]
    reference = cell(rows, REFERENCE_SIZE, GYMNASIUM, "float64", 1)
    ours = cell(rows, REFERENCE_SIZE, "strict", "float64", 1)
    if reference and ours:
        times = three_digits(reference["mean_ns"] / ours["mean_ns"])
        parts.append(
            f"{REFERENCE_SIZE} single environments in Gymnasium's `{GYMNASIUM}`: {millions(reference, 'mean_ns')} "
            f"million a second; ours, with the same bits as result, on one thread is {times} times faster.\n"
        )
    return "\n".join([*parts, noise(rows)])


def cell(rows: list[Row], size: int, arithmetic: str, precision: str, threads: int) -> Row | None:
    """Return one row."""
    return find(rows, environments=size, arithmetic=arithmetic, precision=precision, threads=threads)


def rates(rows: list[Row], which: str) -> str:
    """Return sizes against kinds and threads."""
    columns = [(*kind, threads) for kind in KINDS for threads in distinct(rows, "threads")]
    lines = []
    for size in distinct(rows, "environments"):
        cells = [cell(rows, size, *column) for column in columns]
        real = [row if row and row["threads"] == row["threads_used"] else None for row in cells]
        lines.append([f"{size:,}", *(millions(row, which) for row in real)])
    return table(["environments", *(f"{a} {p}, {named(threads)}" for a, p, threads in columns)], lines)


def headline(content: dict[str, Any]) -> str:
    """Return the rates at the usual size, or the largest measured."""
    rows = content["rows"]
    size = min(SHOWN_SIZE, max(distinct(rows, "environments")))
    most = max(distinct(rows, "threads"))
    shown = [f"{a} {p} {millions(cell(rows, size, a, p, most), 'mean_ns')}" for a, p in KINDS]
    return f"million environment steps/s, resets included, {size:,} environments, {named(most)}: {', '.join(shown)}"


SECTION = Section("environments", "Environments", METHOD, measure, tables, headline)
