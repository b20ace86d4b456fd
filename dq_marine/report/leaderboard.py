"""The leaderboard: how often agents succeed in tasks, vehicle by vehicle, over many seeded episodes."""

from __future__ import annotations

import json
import multiprocessing
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

from dq_marine.agents.choice import make_agents
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.checks import shown
from dq_marine.envs.core.registry import registered_tasks, task_called
from dq_marine.errors import InvalidInputError
from dq_marine.report.sources import fingerprint, sources
from dq_marine.util.extras import extra_needed
from dq_marine.util.files import write_json
from dq_marine.vehicles import load_vehicle, vehicle_names

ONLY_SHOWING = ("cli", "manoeuvres", "viewer", "report", "validation", "identification")
"""Folders of the package that decide nothing about how an agent flies."""


class Entry(NamedTuple):
    """Who flies what: id of the task, vehicle, level, agent."""

    task: str
    vehicle: str
    level: str
    agent: str


@dataclass(frozen=True)
class Plan:
    """How often: episodes of each entry, and the seed of the first; the others count up from it."""

    episodes: int
    seed: int


@dataclass(frozen=True)
class Result:
    """What came out of an entry.

    Attributes:
        entry: who flew what.
        successes: episodes that ended in success.
        episodes: all of them.
        score: as `agents.evaluation.evaluation.Score.as_dict` has it.
    """

    entry: Entry
    successes: int
    episodes: int
    score: dict[str, Any]

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % confidence interval of the rate of success, by Wilson's score.

        Raises:
            MissingDependencyError: SciPy is not installed.
        """
        with extra_needed("a confidence interval", "report"):
            from scipy.stats import binomtest
        found = binomtest(self.successes, self.episodes).proportion_ci(method="wilson")
        return float(found.low), float(found.high)


def entries(
    tasks: Sequence[str], vehicles: Sequence[str], levels: Sequence[str], agents: Sequence[str]
) -> list[Entry]:
    """Return every task with every vehicle that it suits, at every level that it has.

    Args:
        tasks: names or ids; none for all that ship.
        vehicles: of the catalogue; none for all.
        levels: by name.
        agents: baselines by name.

    Raises:
        InvalidInputError: a task, a vehicle or a level is unknown, or nothing is left.
    """
    chosen = [task_called(name) for name in tasks] or [
        one for one in registered_tasks() if one.id.startswith("dq_marine/")
    ]
    loaded = {name: load_vehicle(name) for name in vehicles or vehicle_names()}
    for task in chosen:
        for level in levels:
            task.at_level(level, {})
    found = [
        Entry(task.id, name, level, agent)
        for task in chosen
        for name, vehicle in loaded.items()
        if task.unsuitable(vehicle) is None
        for level in levels
        for agent in agents
    ]
    if not found:
        raise InvalidInputError(
            f"none of the tasks {[task.id for task in chosen]} suits any of the vehicles {list(loaded)}; give others"
        )
    return found


def fly_entry(entry: Entry, plan: Plan) -> Result:
    """Fly all episodes of an entry."""
    keywords = {"vehicle": entry.vehicle, "level": entry.level}
    env = make_environment(EnvironmentSettings(id=entry.task, keywords=keywords))
    agents = make_agents([entry.agent], [], env, seed=plan.seed)
    (score,) = evaluate(env, agents, episodes=plan.episodes, seed=plan.seed)
    return Result(entry, round(score.success_rate * plan.episodes), plan.episodes, score.as_dict())


class Kept:
    """Results on disk, written after each: those of the same plan and sources are not measured again."""

    def __init__(self, path: Path, plan: Plan, *, fresh: bool = False) -> None:
        """Read what there is.

        Raises:
            InvalidInputError: the file is there and cannot be read.
        """
        self.path = path
        self._key = {**asdict(plan), "sources": fingerprint(sources(without=ONLY_SHOWING))}
        self.results: dict[Entry, Result] = {}
        if path.is_file() and not fresh:
            self.results = self._read()

    def add(self, result: Result) -> None:
        """Keep a result, at once."""
        self.results[result.entry] = result
        rows = [asdict(one) | {"entry": one.entry._asdict()} for one in self.results.values()]
        write_json(self.path, {**self._key, "results": rows})

    def _read(self) -> dict[Entry, Result]:
        try:
            content = json.loads(self.path.read_text(encoding="utf-8"))
            if any(content[name] != value for name, value in self._key.items()):
                return {}
            rows = [
                Result(Entry(**row["entry"]), row["successes"], row["episodes"], row["score"])
                for row in content["results"]
            ]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InvalidInputError(
                f"{self.path} is no leaderboard: {shown(error)}; move it away, or give --fresh"
            ) from error
        return {one.entry: one for one in rows}


def fly_all(
    wanted: Iterable[Entry], plan: Plan, kept: Kept, *, processes: int, after: Callable[[Result], None]
) -> list[Result]:
    """Return the results of entries, in their order; what is kept is not flown again.

    Args:
        wanted: what is to be flown.
        plan: how often.
        kept: results of before; new ones are added.
        processes: that fly at a time.
        after: called with each result that is new.
    """
    asked = list(wanted)
    missing = [entry for entry in asked if entry not in kept.results]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max(1, min(processes, len(missing))), mp_context=context) as pool:
        try:
            for done in as_completed([pool.submit(fly_entry, entry, plan) for entry in missing]):
                kept.add(done.result())
                after(done.result())
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return [kept.results[entry] for entry in asked]


def markdown(results: Sequence[Result], command: str, circumstances: str) -> str:
    """Return the page: a table a task."""
    lines = ["# Leaderboard", "", f"`{command}`", "", circumstances, ""]
    lines += [
        "Success is what the task says of it, at the end of an episode; in brackets the 95 % interval by Wilson.",
        "Other columns are means of the last third of an episode, as median over the episodes.",
    ]
    for task in dict.fromkeys(one.entry.task for one in results):
        lines += ["", f"## {task}", "", *_table([one for one in results if one.entry.task == task])]
    return "\n".join(lines) + "\n"


def _table(results: Sequence[Result]) -> list[str]:
    names = list(results[0].score["metrics"])
    heading = ["vehicle", "level", "agent", "success", *(f"`{name}`" for name in names), "ended early"]
    rows = [heading, ["---"] * 3 + ["---:"] * (len(heading) - 3)]
    for one in results:
        low, high = one.interval
        success = f"{one.successes} of {one.episodes} ({low:.1%} to {high:.1%})"
        metrics = [f"{one.score['metrics'][name]['steady']['median']:.3g}" for name in names]
        early = f"{one.score['early_end_rate']:.1%}"
        rows.append([one.entry.vehicle, one.entry.level, one.entry.agent, success, *metrics, early])
    return ["| " + " | ".join(row) + " |" for row in rows]
