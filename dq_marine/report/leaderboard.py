"""The leaderboard: how well agents do tasks, over many seeded episodes with every vehicle, and in named scenarios."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from dq_marine.agents.choice import make_agents
from dq_marine.agents.controllers.baselines import MODEL_BASED, make_baseline
from dq_marine.agents.environments import make_environment, scenario_settings
from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.checks import one_of, shown
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.perturbations import PERTURBATIONS
from dq_marine.envs.core.registry import shipped_tasks, task_called
from dq_marine.envs.scenarios.files import load_scenario, scenarios_of
from dq_marine.errors import InvalidInputError
from dq_marine.report.interquartile import Interval, interquartile_interval
from dq_marine.report.leaderboard_policies import Policy
from dq_marine.report.sources import fingerprint, sources
from dq_marine.util.extras import extra_needed
from dq_marine.util.files import write_whole
from dq_marine.util.side_by_side import Team
from dq_marine.vehicles import load_vehicle, vehicle_names

NOT_FLYING = (
    *("cli", "manoeuvres", "viewer", "report", "validation", "identification"),
    *("agents/interactive", "agents/shipped", "agents/training", "agents/tuning"),
)
"""Folders of the package that decide nothing about how an agent flies; a policy is known by its own digest."""


class Entry(NamedTuple):
    """Who flies what: the task's id, vehicle, level ("" for none), agent; names of scenario and perturbation, or ""."""

    task: str
    vehicle: str
    level: str
    agent: str
    scenario: str = ""
    perturbation: str = ""


@dataclass(frozen=True)
class Plan:
    """How often: episodes of each entry without a scenario, and the seed of the first; the others count up from it."""

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
        figures: of what `Episode.figures` has, interquartile means over the episodes and their intervals.
        policy: a hash over the model of a trained policy; "" of a baseline.
    """

    entry: Entry
    successes: int
    episodes: int
    score: dict[str, Any]
    figures: dict[str, Interval]
    policy: str = ""

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % confidence interval of the rate of success; see `wilson_interval`."""
        return wilson_interval(self.successes, self.episodes)


def wilson_interval(successes: int, episodes: int) -> tuple[float, float]:
    """Return the 95 % confidence interval of a rate, by Wilson's score.

    Raises:
        MissingDependencyError: SciPy is not installed.
    """
    with extra_needed("a confidence interval", "report"):
        from scipy.stats import binomtest
    found = binomtest(successes, episodes).proportion_ci(method="wilson")
    return float(found.low), float(found.high)


def entries(
    tasks: Sequence[str],
    vehicles: Sequence[str],
    levels: Sequence[str],
    agents: Sequence[str],
    policies: Sequence[Policy] = (),
    perturbations: Sequence[str] = (),
) -> list[Entry]:
    """Return every task with every vehicle that it suits, at every level that it has, as planned and perturbed.

    Args:
        tasks: names or ids; none for all that ship.
        vehicles: of the catalogue; none for all.
        levels: by name.
        agents: baselines by name; where one cannot fly it is left out.
        policies: trained ones, each for its task and vehicle, at the levels whose environments it fits.
        perturbations: by name; where a vehicle cannot have one, such as a lost propeller, it is left out.

    Raises:
        InvalidInputError: a task, a vehicle, a level or a perturbation is unknown, or nothing is left.
    """
    for name in perturbations:
        one_of("perturb", name, PERTURBATIONS)
    chosen = chosen_tasks(tasks)
    loaded = {name: load_vehicle(name) for name in vehicles or vehicle_names()}
    for task in chosen:
        for level in levels:
            task.at_level(level, {})
    found = []
    for task in chosen:
        for name in (one for one, vehicle in loaded.items() if task.unsuitable(vehicle) is None):
            for level, perturbation in product(levels, ("", *perturbations)):
                entry = Entry(task.id, name, level, "", perturbation=perturbation)
                environment = environment_of(entry)
                if perturbation and not _can_be_made(environment):
                    continue
                able = able_baselines(agents, environment)
                able += [one.name for one in policies if one.vehicle == name and one.fits(environment)]
                found += [entry._replace(agent=agent) for agent in able]
    if not found:
        raise InvalidInputError(
            f"none of the tasks {[task.id for task in chosen]} suits any of the vehicles {list(loaded)}, or none of "
            "the agents can fly them; give others"
        )
    return found


def scenario_entries(
    tasks: Sequence[str], vehicles: Sequence[str], agents: Sequence[str], policies: Sequence[Policy] = ()
) -> list[Entry]:
    """Return every scenario that ships, for every agent.

    Args:
        tasks: names or ids; none for all.
        vehicles: that the scenarios are to be with; none for any.
        agents: baselines by name; where one cannot fly it is left out.
        policies: trained ones, each in the scenarios that it fits.

    Raises:
        InvalidInputError: a task is unknown, or there are no such scenarios.
    """
    found = []
    for task in chosen_tasks(tasks):
        for one in scenarios_of(task.id):
            vehicle = str(one.keywords.get("vehicle", task.vehicle))
            if vehicles and vehicle not in vehicles:
                continue
            environment, level = scenario_settings(one), str(one.keywords.get("level", ""))
            able = able_baselines(agents, environment)
            able += [policy.name for policy in policies if policy.fits(environment)]
            found += [Entry(task.id, vehicle, level, agent, one.name) for agent in able]
    if not found:
        vessels = f"the vehicles {list(vehicles)}" if vehicles else "any vehicle"
        raise InvalidInputError(
            f"no scenarios ship for the tasks {list(tasks)} with {vessels} that the agents "
            f"{[*agents, *(one.name for one in policies)]} can fly; give others"
        )
    return found


def _can_be_made(environment: EnvironmentSettings) -> bool:
    try:
        make_environment(environment).close()
    except InvalidInputError:
        return False
    return True


def able_baselines(names: Sequence[str], environment: EnvironmentSettings) -> list[str]:
    """Return those of some baselines that can fly in an environment: LQR and MPC cannot in every one.

    Raises:
        MissingDependencyError: the libraries that LQR and MPC need are not installed.
    """
    if MODEL_BASED.keys().isdisjoint(names):
        return list(names)
    env, able = make_environment(environment), []
    for name in names:
        with contextlib.suppress(InvalidInputError):
            make_baseline(name, env)
            able.append(name)
    env.close()
    return able


def chosen_tasks(names: Sequence[str]) -> list[TaskDefinition]:
    """Return tasks by names or ids; without any, all that ship.

    Raises:
        InvalidInputError: one is unknown.
    """
    return [task_called(name) for name in names] or list(shipped_tasks())


def environment_of(entry: Entry) -> EnvironmentSettings:
    """Return what an entry is flown in."""
    if entry.scenario:
        return scenario_settings(load_scenario(f"{entry.task}/{entry.scenario}"))
    perturbed = {"perturb": entry.perturbation} if entry.perturbation else {}
    keywords = {"vehicle": entry.vehicle, "level": entry.level, **perturbed}
    return EnvironmentSettings(id=entry.task, keywords=keywords)


def fly_entry(entry: Entry, plan: Plan, policy: Policy | None = None) -> Result:
    """Fly all episodes of an entry: those of the plan, or that of its scenario.

    Args:
        entry: who flies what.
        plan: how often, where it is no scenario.
        policy: the trained one that the entry's agent is; None for a baseline.
    """
    options: dict[str, Any] = {}
    if entry.scenario:
        scenario = load_scenario(f"{entry.task}/{entry.scenario}")
        plan, options = Plan(1, scenario.seed), dict(scenario.reset)
    environment = environment_of(entry)
    env = make_environment(environment if policy is None else policy.flown_in(environment))
    baselines, runs = ([entry.agent], []) if policy is None else ([], [policy.path])
    agents = make_agents(baselines, runs, env, seed=plan.seed)
    flown: list[dict[str, float]] = []

    def keep(_: str, episode: Episode) -> None:
        flown.append(episode.figures())

    (score,) = evaluate(
        env, agents, episodes=plan.episodes, seed=plan.seed, options=options, after_episode=keep
    )
    figures = {name: interquartile_interval([one[name] for one in flown]) for name in flown[0]}
    successes = round(score.success_rate * plan.episodes)
    digest = "" if policy is None else policy.digest
    return Result(entry, successes, plan.episodes, score.as_dict(), figures, digest)


class Kept:
    """Results on disk, written after each: those of the same plan and sources are not measured again."""

    def __init__(self, path: Path, plan: Plan, *, fresh: bool = False) -> None:
        """Read what there is.

        Raises:
            InvalidInputError: the file is there and cannot be read.
        """
        self.path = path
        self._key = {**asdict(plan), "sources": fingerprint(sources(without=NOT_FLYING))}
        self.results: dict[Entry, Result] = {}
        if path.is_file() and not fresh:
            content, results = read_results(path)
            if all(content.get(name) == value for name, value in self._key.items()):
                self.results = {one.entry: one for one in results}

    def add(self, result: Result) -> None:
        """Keep a result, at once; the file has a line for each."""
        self.results[result.entry] = result
        rows = [asdict(one) | {"entry": one.entry._asdict()} for one in self.results.values()]
        head = json.dumps({**self._key, "results": []}).removesuffix("]}")
        write_whole(self.path, head + "\n" + ",\n".join(map(json.dumps, rows)) + "\n]}\n")

    def missing(self, wanted: Iterable[Entry], policies: Mapping[str, Policy]) -> list[Entry]:
        """Return the entries that have no result yet, or one of another model of the policy."""
        digests = {name: policy.digest for name, policy in policies.items()}
        return [
            entry
            for entry in wanted
            if entry not in self.results or self.results[entry].policy != digests.get(entry.agent, "")
        ]


def read_results(path: Path) -> tuple[dict[str, Any], list[Result]]:
    """Return what a leaderboard's file says besides its results, and these.

    Raises:
        InvalidInputError: it cannot be read, or is no such file.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        rows = content.pop("results")
        results = [
            Result(
                **row
                | {
                    "entry": Entry(**row["entry"]),
                    "figures": {name: Interval(*value) for name, value in row["figures"].items()},
                }
            )
            for row in rows
        ]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InvalidInputError(
            f"{path} is no leaderboard: {shown(error)}; move it away, or give --fresh"
        ) from error
    return content, results


def fly_all(
    wanted: Iterable[Entry],
    plan: Plan,
    kept: Kept,
    *,
    team: Team,
    after: Callable[[Result], None],
    policies: Sequence[Policy] = (),
) -> list[Result]:
    """Return the results of entries, in their order; what is kept is not flown again.

    Args:
        wanted: what is to be flown.
        plan: how often.
        kept: results of before; new ones are added.
        team: who fly them.
        after: called with each result that is new.
        policies: the trained ones among the agents.
    """
    asked = list(wanted)
    trained = {one.name: one for one in policies}
    missing = kept.missing(asked, trained)
    if missing:  # a cluster takes seconds to begin
        with team(len(missing)) as pool:
            flights = [pool.submit(fly_entry, entry, plan, trained.get(entry.agent)) for entry in missing]
            for done in as_completed(flights):
                kept.add(done.result())
                after(done.result())
    return [kept.results[entry] for entry in asked]
