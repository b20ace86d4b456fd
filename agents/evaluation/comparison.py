"""Comparing flights: from one start, by several agents or under several settings, in one page."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import numpy as np
from rich.table import Table
from rich.text import Text

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.flight import (
    FlightPlan,
    Outputs,
    episode_rows,
    far_seed,
    open_flight,
    options_of,
    periods_of,
)
from dq_marine.agents.settings import EnvironmentSettings

if TYPE_CHECKING:
    from dq_marine.viewer.shared_scene import Flight


@dataclass(frozen=True)
class Contender:
    """One of those that are compared.

    Attributes:
        environment: what it flies in.
        make_agent: given the environment and the seed, returns the agent that flies it.
    """

    environment: EnvironmentSettings
    make_agent: Callable[[gym.Env[Any, Any], int], Agent]


@dataclass(frozen=True)
class Flown:
    """What became of a contender.

    Attributes:
        episode: what was flown.
        flight: to be shown, with the task's metrics as plots.
    """

    episode: Episode
    flight: Flight


def fly_contenders(
    contenders: Mapping[str, Contender],
    plan: FlightPlan,
    html: Path,
    *,
    progress: Callable[[float], None] = lambda done: None,
) -> dict[str, Flown]:
    """Fly one episode with each, all from the same seed and the same start.

    The seed and the start are those of the first: where the settings of another draw another start, it is put there.

    Args:
        contenders: by name.
        plan: what to fly, but for the environment, which each contender has its own.
        html: the page that will be written; it is refused before the first flight if it cannot be.
        progress: is told what part is done, from 0 to 1.

    Raises:
        InvalidInputError: the plan is wrong, or a contender cannot fly it.
        MissingDependencyError: the libraries that an agent needs are not installed.
    """
    plans = {name: replace(plan, environment=one.environment) for name, one in contenders.items()}
    seed = far_seed(next(iter(plans.values()))) if plan.seed is None else plan.seed
    flown: dict[str, Flown] = {}
    start: dict[str, Any] = {}
    for number, (name, contender) in enumerate(contenders.items()):

        def told(share: float, number: int = number) -> None:
            progress((number + share) / len(contenders))

        env, _ = open_flight(replace(plans[name], seed=seed), Outputs(html=html))
        try:
            options = options_of(env, plans[name], seed)
            env.reset(seed=seed, options=options)
            start = start or _start_of(env)
            if not _is_at(env, start):
                options |= start
            agent = _Watched(contender.make_agent(env, seed), periods_of(plans[name], env), told)
            episode = fly_episode(env, agent, seed=seed, options=options)
            flown[name] = Flown(episode, _flight(env, name, episode))
        finally:
            env.close()
    return flown


def comparison_table(flown: Mapping[str, Flown]) -> Table:
    """Return what came out of the flights, a column each."""
    columns = [episode_rows(one.episode) for one in flown.values()]
    table = Table()
    table.add_column("")
    for name in flown:
        table.add_column(Text(name), justify="right")
    for quantity in dict.fromkeys(quantity for rows in columns for quantity in rows):
        table.add_row(quantity, *(Text(rows.get(quantity, "")) for rows in columns))
    return table


def save_comparison(path: Path, flights: Sequence[Flight], *, title: str, side_by_side: bool = False) -> None:
    """Write flights as one page, overlaid in one scene or side by side.

    Raises:
        InvalidInputError: they cannot be shown in one scene, or the path cannot be written.
        MissingDependencyError: meshcat is not installed.
    """
    if side_by_side:
        from dq_marine.viewer.replay import make_replay
        from dq_marine.viewer.side_by_side import save_side_by_side

        replays = {one.name: make_replay(one.snapshots, one.shape, title=one.caption) for one in flights}
        save_side_by_side(path, replays, title=title)
    else:
        from dq_marine.viewer.overlay import save_overlay

        save_overlay(path, flights, title=title)


class _Watched:
    """An agent of which is told how far its flight has come, if it is known how many control periods that has."""

    def __init__(self, agent: Agent, periods: int | None, told: Callable[[float], None]) -> None:
        self._agent, self._periods, self._told = agent, periods, told
        self._done = 0

    def reset(self, env: gym.Env[Any, Any]) -> None:
        self._agent.reset(env)

    def act(self, observation: Any) -> Any:
        self._done += 1
        if self._periods is not None:
            self._told(self._done / self._periods)
        return self._agent.act(observation)


def _start_of(env: gym.Env[Any, Any]) -> dict[str, Any]:
    """Return options of reset that put a vehicle where one is now."""
    inner = marine(env)
    return {
        "position": inner.position_ned,
        "quaternion": inner.quaternion_body_to_ned,
        "velocity": inner.velocity_body,
    }


def _is_at(env: gym.Env[Any, Any], start: Mapping[str, Any]) -> bool:
    return all(np.array_equal(value, start[name]) for name, value in _start_of(env).items())


def _flight(env: gym.Env[Any, Any], name: str, episode: Episode) -> Flight:
    """Return the recorded episode with the task's metrics as plots, and a word on how it ended."""
    plots = {metric.heading(): metric.shown(episode.measured[metric.name]) for metric in episode.metrics}
    hit = ", having hit something" if episode.collided else ""
    caption = f"ended early, after {episode.time[-1]:.1f} s{hit}" if episode.ended_early else ""
    return replace(marine(env).recorded_flight(name), caption=caption, plots=plots)
