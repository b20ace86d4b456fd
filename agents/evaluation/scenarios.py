"""Comparing agents in scenarios: each scenario begins as it says, for every agent alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium as gym

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.evaluation import Score, evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.registry import full_id, registered_tasks
from dq_marine.envs.scenarios.files import load_scenario, scenarios_of
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError
from dq_marine.util.parted_table import Column, PartedTable


@dataclass(frozen=True)
class ScenarioScores:
    """What agents achieved in a scenario.

    Attributes:
        scenario: which.
        environment: that was flown in: the scenario's, or what was asked for in its place.
        seed: of the first episode.
        scores: of the agents.
    """

    scenario: Scenario
    environment: EnvironmentSettings
    seed: int
    scores: list[Score]

    def as_dict(self) -> dict[str, Any]:
        """Return everything as nested dictionaries, for JSON."""
        return {
            "scenario": self.scenario.model_dump(mode="json"),
            "environment": self.environment.model_dump(mode="json"),
            "seed": self.seed,
            "scores": [score.as_dict() for score in self.scores],
        }


def chosen_scenarios(names: Sequence[str], *, task: str | None = None) -> list[Scenario]:
    """Return scenarios of one task, each once.

    Args:
        names: each as `load_scenario` takes it, or the name of a task, which stands for all that ship for it.
        task: that they must be of, by name or id.

    Raises:
        InvalidInputError: one is unknown, a task has none, or they are of different tasks, which measure differently.
    """
    found: list[Scenario] = []
    for name in names:
        found += [one for one in _meant(name, task) if one not in found]
    tasks = sorted({one.definition.id for one in found})
    if len(tasks) > 1:
        raise InvalidInputError(
            f"the scenarios are of {' and '.join(tasks)}, which measure different things; give those of one at a time"
        )
    return found


def _meant(name: str, task: str | None) -> Sequence[Scenario]:
    if full_id(name) not in {one.id for one in registered_tasks()}:
        return [load_scenario(name, task=task)]
    found = scenarios_of(name)
    if not found:
        raise InvalidInputError(f"no scenarios ship for {full_id(name)}; give the path of a file with some")
    return [load_scenario(one, task=task) for one in found]


def evaluate_scenario(
    scenario: Scenario,
    environment: EnvironmentSettings,
    make_agents: Callable[[gym.Env[Any, Any]], Mapping[str, Agent]],
    *,
    episodes: int = 1,
    seed: int | None = None,
    after_episode: Callable[[str, Episode], None] | None = None,
    track: bool = False,
) -> ScenarioScores:
    """Fly a scenario with every agent.

    Args:
        scenario: what every episode begins as.
        environment: that it is flown in.
        make_agents: given the environment, returns the agents that fly it, by name.
        episodes: of each agent; those after the first have seeds that count up, and differ in what the seed fixes.
        seed: of the first; None for the scenario's.
        after_episode: called with the agent's name and the episode after each one.
        track: whether episodes keep where the vehicle was.

    Raises:
        InvalidInputError: an agent cannot fly in this environment.
    """
    first = scenario.seed if seed is None else seed
    env = make_environment(environment)
    scores = evaluate(
        env,
        make_agents(env),
        episodes=episodes,
        seed=first,
        options=dict(scenario.reset),
        after_episode=after_episode,
        track=track,
    )
    return ScenarioScores(scenario, environment, first, scores)


def scenarios_table(results: Sequence[ScenarioScores]) -> PartedTable:
    """Return what came out of several scenarios of a task as a table for Rich: means over the episodes of each."""
    scores = [score for result in results for score in result.scores]
    numbers = [
        Column("success", [f"{one.success_rate:.0%}" for one in scores]),
        Column("return", [f"{one.returns.mean:.1f}" for one in scores]),
    ]
    for name, first in scores[0].metrics.items():
        means = [first.metric.text(one.metrics[name].steady.mean, unit=False) for one in scores]
        numbers.append(Column(first.metric.heading(), means))
    numbers.append(Column("effort", [f"{one.effort.mean:.3f}" for one in scores]))
    hits = [one.collision_rate for one in scores if one.collision_rate is not None]
    if len(hits) == len(scores):
        numbers.append(Column("collided", [f"{hit:.0%}" for hit in hits]))
    return PartedTable(
        names=[
            Column("scenario", [result.scenario.name for result in results for _ in result.scores]),
            Column("agent", [one.agent for one in scores]),
        ],
        numbers=numbers,
        caption="metrics: mean over the last third of an episode; effort: mean square of the actions",
    )
