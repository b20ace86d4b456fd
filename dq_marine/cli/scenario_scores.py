"""What `dq-marine evaluate --scenario` does: agents in scenarios, as a table and as JSON."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.choice import make_agents
from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.evaluation import score_table
from dq_marine.agents.evaluation.scenarios import (
    ScenarioScores,
    chosen_scenarios,
    evaluate_scenario,
    scenarios_table,
)
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.cli.agent_options import EnvironmentOptions, requested_environment
from dq_marine.cli.common import console
from dq_marine.cli.options import print_preset
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import write_json


@dataclass(frozen=True)
class Flights:
    """What was asked for.

    Attributes:
        names: of scenarios, of their files or tasks.
        options: of the environment, which win over what the scenarios say.
        preset: that was asked for, too; refused.
        baselines: agents by name.
        runs: folders of training runs, whose policies fly.
        episodes: of each agent in each scenario.
        seed: of the first; None for the scenarios' own.
    """

    names: Sequence[str]
    options: EnvironmentOptions
    preset: str | None
    baselines: Sequence[str]
    runs: list[Path]
    episodes: int
    seed: int | None

    def make_agents(self, env: gym.Env[Any, Any]) -> dict[str, Agent]:
        """Return the agents for an environment, by name."""
        return make_agents(self.baselines, self.runs, env, seed=self.seed or 0)

    def environments(self) -> list[tuple[Scenario, EnvironmentSettings]]:
        """Return the scenarios, each with the environment to fly it in."""
        chosen = chosen_scenarios(self.names, task=self.options.task)
        return [
            (one, requested_environment(self.runs, self.options, preset=self.preset, scenario=one))
            for one in chosen
        ]


def evaluate_scenarios(
    flights: Flights, json: Path | None, keep: Callable[[str, Episode], None] | None, only_print: bool
) -> None:
    """Fly the scenarios and show what came out.

    Args:
        flights: what was asked for.
        json: file for the scores; None for none.
        keep: called with SCENARIO_AGENT and the episode after each one; None to keep none.
        only_print: print the environment that would be used, and fly nothing.
    """
    environments = flights.environments()
    if only_print:
        if len(environments) > 1:
            raise InvalidInputError(
                f"--print-preset shows one environment, not {len(environments)}; give one scenario"
            )
        print_preset(environments[0][1], "environment")
        return
    results = _flown(flights, environments, keep)
    table = score_table(results[0].scores) if len(results) == 1 else scenarios_table(results)
    console.print(table)
    if json is not None:
        write_json(json, [one.as_dict() for one in results])
        console.print(f"Wrote {json}", soft_wrap=True)


def _flown(
    flights: Flights, environments: list[tuple[Scenario, EnvironmentSettings]], keep: Any
) -> list[ScenarioScores]:
    """Fly behind a progress bar."""
    from rich.progress import Progress

    agents = len(flights.baselines) + len(flights.runs)
    results = []
    with Progress(console=console, transient=True) as bar:
        shown = bar.add_task("evaluating", total=flights.episodes * agents * len(environments))
        for scenario, environment in environments:

            def advance(agent: str, episode: Episode, name: str = scenario.name) -> None:
                if keep is not None:
                    keep(f"{name}_{agent}", episode)
                bar.update(shown, advance=1, description=f"{name}, {agent}")

            results.append(
                evaluate_scenario(
                    scenario,
                    environment,
                    flights.make_agents,
                    episodes=flights.episodes,
                    seed=flights.seed,
                    after_episode=advance,
                    track=keep is not None,
                )
            )
    return results
