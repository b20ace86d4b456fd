"""Comparing agents: the same seeded episodes for each, and a table of what came out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

from dq_marine.agents.episodes import Episode, fly_episode
from dq_marine.agents.policies import Agent


@dataclass(frozen=True)
class Spread:
    """How a quantity is spread over episodes."""

    mean: float
    median: float
    p95: float


@dataclass(frozen=True)
class Score:
    """What an agent achieved over a number of episodes.

    "Final" is an episode's last instant, "steady" its mean over the last third.

    Attributes:
        agent: name.
        episodes: how many.
        returns: undiscounted sum of rewards.
        final_position_error: [m].
        steady_position_error: [m].
        final_attitude_error_deg: [degrees].
        steady_attitude_error_deg: [degrees].
        success_rate: fraction of episodes that ended on station.
        early_end_rate: fraction of episodes that were terminated, say beyond the workspace.
    """

    agent: str
    episodes: int
    returns: Spread
    final_position_error: Spread
    steady_position_error: Spread
    final_attitude_error_deg: Spread
    steady_attitude_error_deg: Spread
    success_rate: float
    early_end_rate: float

    def as_dict(self) -> dict[str, Any]:
        """Return the score as nested dictionaries, for JSON."""
        return asdict(self)


def evaluate(
    env: gym.Env[Any, Any],
    agents: Mapping[str, Agent],
    *,
    episodes: int,
    seed: int,
    after_episode: Callable[[str], None] | None = None,
) -> list[Score]:
    """Fly episodes seeded seed, seed + 1, ... with every agent.

    Args:
        env: made with a time limit.
        agents: by name.
        episodes: of each agent, at least 1.
        seed: of the first episode.
        after_episode: called with the agent's name after each episode, to tell progress.
    """
    scores = []
    for name, agent in agents.items():
        flown = []
        for index in range(episodes):
            flown.append(fly_episode(env, agent, seed=seed + index))
            if after_episode is not None:
                after_episode(name)
        scores.append(score(name, flown))
    return scores


def score(name: str, episodes: Sequence[Episode]) -> Score:
    """Return the score of an agent that flew these episodes."""
    attitudes = [np.degrees(episode.attitude_error) for episode in episodes]
    return Score(
        agent=name,
        episodes=len(episodes),
        returns=spread([episode.total_reward for episode in episodes]),
        final_position_error=spread([float(episode.position_error[-1]) for episode in episodes]),
        steady_position_error=spread(
            [episode.position_error[episode.last_third].mean() for episode in episodes]
        ),
        final_attitude_error_deg=spread([attitude[-1] for attitude in attitudes]),
        steady_attitude_error_deg=spread(
            [
                attitude[episode.last_third].mean()
                for attitude, episode in zip(attitudes, episodes, strict=True)
            ]
        ),
        success_rate=float(np.mean([episode.success for episode in episodes])),
        early_end_rate=float(np.mean([episode.ended_early for episode in episodes])),
    )


def spread(values: Sequence[float]) -> Spread:
    """Return mean, median and 95th percentile."""
    return Spread(float(np.mean(values)), float(np.median(values)), float(np.percentile(values, 95)))


def score_table(scores: Sequence[Score]) -> Table:
    """Return the scores as a table, each quantity as mean, median and 95th percentile."""
    table = Table(
        title=f"{scores[0].episodes} episodes each, the same starts and currents for every agent",
        caption="steady: mean over the last third of an episode",
        box=SIMPLE_HEAD,
        pad_edge=False,
        collapse_padding=True,
    )
    table.add_column("agent", style="bold", no_wrap=True)
    table.add_column("", style="dim")
    for heading in (
        "return",
        "final\n[m]",
        "steady\n[m]",
        "final\n[deg]",
        "steady\n[deg]",
        "success",
        "ended\nearly",
    ):
        table.add_column(Text(heading), justify="right")  # as text: [m] would be taken for markup
    for one in scores:
        table.add_row(
            one.agent,
            "mean\nmedian\n95 %",
            _lines(one.returns, ".1f"),
            _lines(one.final_position_error, ".3f"),
            _lines(one.steady_position_error, ".3f"),
            _lines(one.final_attitude_error_deg, ".2f"),
            _lines(one.steady_attitude_error_deg, ".2f"),
            f"{one.success_rate:.0%}",
            f"{one.early_end_rate:.0%}",
            end_section=True,
        )
    return table


def _lines(values: Spread, form: str) -> str:
    return "\n".join(f"{value:{form}}" for value in (values.mean, values.median, values.p95))
