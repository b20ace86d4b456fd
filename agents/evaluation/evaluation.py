"""Comparing agents: the same seeded episodes for each, and a table of what came out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.metrics import Metric
from dq_marine.errors import InvalidInputError
from dq_marine.util.parted_table import Column, PartedTable


@dataclass(frozen=True)
class Spread:
    """How a quantity is spread over episodes."""

    mean: float
    median: float
    p95: float


@dataclass(frozen=True)
class MetricScore:
    """How a metric is spread over episodes, in the unit that people read.

    Attributes:
        metric: what was measured.
        final: at an episode's last instant.
        steady: its mean over the last third of an episode.
    """

    metric: Metric
    final: Spread
    steady: Spread


@dataclass(frozen=True)
class Score:
    """What an agent achieved over a number of episodes.

    Attributes:
        agent: name.
        episodes: how many.
        returns: undiscounted sum of rewards.
        metrics: of the task, by name.
        success_rate: fraction of episodes at whose end the task counted as done.
        early_end_rate: fraction of episodes that were terminated, say beyond the workspace.
        effort: mean square of an episode's actions.
        action_change: root mean square of the change of its actions from period to period.
        collision_rate: fraction of episodes in which the vehicle hit something; None where there is nothing to hit.
    """

    agent: str
    episodes: int
    returns: Spread
    metrics: dict[str, MetricScore]
    success_rate: float
    early_end_rate: float
    effort: Spread
    action_change: Spread
    collision_rate: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return the score as nested dictionaries, for JSON; the names of metrics have their unit at the end."""
        metrics = {
            one.metric.shown_name: {"final": asdict(one.final), "steady": asdict(one.steady)}
            for one in self.metrics.values()
        }
        spreads = {name: asdict(getattr(self, name)) for name in ("returns", "effort", "action_change")}
        return vars(self) | spreads | {"metrics": metrics}


def evaluate(
    env: gym.Env[Any, Any],
    agents: Mapping[str, Agent],
    *,
    episodes: int,
    seed: int,
    options: dict[str, Any] | None = None,
    after_episode: Callable[[str, Episode], None] | None = None,
    track: bool = False,
) -> list[Score]:
    """Fly episodes seeded seed, seed + 1, ... with every agent.

    Args:
        env: made with a time limit.
        agents: by name.
        episodes: of each agent, at least 1.
        seed: of the first episode.
        options: of the environment's reset.
        after_episode: called with the agent's name and the episode after each one, to tell progress or to keep it.
        track: whether episodes keep where the vehicle was.
    """
    scores = []
    for name, agent in agents.items():
        flown = []
        for index in range(episodes):
            flown.append(fly_episode(env, agent, seed=seed + index, options=options, track=track))
            if after_episode is not None:
                after_episode(name, flown[-1])
        scores.append(score(name, flown))
    return scores


def score(name: str, episodes: Sequence[Episode]) -> Score:
    """Return the score of an agent that flew these episodes."""
    hits = [episode.collided for episode in episodes if episode.collided is not None]
    return Score(
        agent=name,
        episodes=len(episodes),
        returns=spread([episode.total_reward for episode in episodes]),
        metrics={metric.name: _metric_score(metric, episodes) for metric in episodes[0].metrics},
        success_rate=float(np.mean([episode.success for episode in episodes])),
        early_end_rate=float(np.mean([episode.ended_early for episode in episodes])),
        effort=spread([episode.effort for episode in episodes]),
        action_change=spread([episode.action_change for episode in episodes]),
        collision_rate=float(np.mean(hits)) if hits else None,
    )


def _metric_score(metric: Metric, episodes: Sequence[Episode]) -> MetricScore:
    measured = [metric.shown(episode.measured[metric.name]) for episode in episodes]
    steady = [
        float(values[episode.last_third].mean()) for values, episode in zip(measured, episodes, strict=True)
    ]
    return MetricScore(metric, spread([float(values[-1]) for values in measured]), spread(steady))


def spread(values: Sequence[float]) -> Spread:
    """Return mean, median and 95th percentile."""
    return Spread(float(np.mean(values)), float(np.median(values)), float(np.percentile(values, 95)))


def score_table(scores: Sequence[Score], notes: Sequence[str] = ()) -> PartedTable:
    """Return the scores as a table for Rich, quantities as mean, median and 95th percentile; notes stand below.

    Raises:
        InvalidInputError: there are none.
    """
    if not scores:
        raise InvalidInputError("there are no scores to show; evaluate an agent first")
    return PartedTable(
        names=[
            Column("agent", [one.agent for one in scores], style="bold"),
            Column("", ["mean\nmedian\n95 %" for _ in scores], style="dim"),
        ],
        numbers=[
            Column("return", [_lines(one.returns, "{:.1f}".format) for one in scores]),
            *(column for name in scores[0].metrics for column in _of_metric(name, scores)),
            Column("success", [f"{one.success_rate:.0%}" for one in scores]),
            Column("ended early", [f"{one.early_end_rate:.0%}" for one in scores]),
        ],
        title=f"{scores[0].episodes} episodes each, the same starts and currents for every agent",
        caption="\n".join(["steady: mean over the last third of an episode", *notes]),
        ruled=True,
    )


def _of_metric(name: str, scores: Sequence[Score]) -> tuple[Column, Column]:
    """Return a metric's two columns."""
    measured = [one.metrics[name] for one in scores]
    metric = measured[0].metric
    text = partial(metric.text, unit=False)
    return (
        Column(metric.heading("final"), [_lines(one.final, text) for one in measured]),
        Column(metric.heading("steady"), [_lines(one.steady, text) for one in measured]),
    )


def _lines(values: Spread, text: Callable[[float], str]) -> str:
    return "\n".join(text(value) for value in (values.mean, values.median, values.p95))
