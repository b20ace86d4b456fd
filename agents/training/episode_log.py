"""Metrics of episodes in TensorBoard: those that an agent learns from, and those of evaluations."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from dq_marine.agents.evaluation.metrics import SUCCESS, Metric, metrics_of
from dq_marine.agents.training.reward_sums import SUM_PREFIX
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.vec_env import VecEnv

EPISODES = 100
"""Of late, over which is averaged, as Stable-Baselines3 averages its `rollout/ep_rew_mean`."""


RATES = {SUCCESS: "success_rate", "refused": "refused_rate"}
"""Of what is true or false at an end, the mean over episodes is a rate."""


def episode_tags(info: Mapping[str, Any], metrics: Sequence[Metric]) -> dict[str, float]:
    """Return what is logged of an ended episode, by its tag.

    Metrics at the end have a tag like `episode_end/depth_error_m`, with the unit that people read; sums of reward terms
    have one like `episode_reward/effort`; rates are `episode_end/success_rate` and `episode_end/refused_rate`, of steps
    that the integrator refused.

    Args:
        info: of the step that ended it.
        metrics: of the task.
    """
    shown = {
        f"episode_end/{metric.shown_name}": float(metric.shown(info[metric.name]))
        for metric in metrics
        if metric.name in info
    }
    sums = {name: float(value) for name, value in info.items() if name.startswith(SUM_PREFIX)}
    rates = {f"episode_end/{rate}": float(info[name]) for name, rate in RATES.items() if name in info}
    return shown | rates | sums


def metrics_in(envs: VecEnv) -> tuple[Metric, ...]:
    """Return the metrics of the task that environments do."""
    return metrics_of(envs.get_attr("definition", 0)[0])


def mean_tags(episodes: Collection[Mapping[str, float]]) -> dict[str, float]:
    """Return the mean of each tag over the episodes that have it."""
    names = dict.fromkeys(name for episode in episodes for name in episode)
    return {name: float(np.mean([one[name] for one in episodes if name in one])) for name in names}


class EpisodeLog(BaseCallback):
    """Logs the means over the last episodes of training, whenever one has ended."""

    def __init__(self) -> None:
        """Begin without episodes."""
        super().__init__()
        self._late: deque[dict[str, float]] = deque(maxlen=EPISODES)
        self._metrics: tuple[Metric, ...] = ()

    def _on_training_start(self) -> None:
        self._metrics = metrics_in(self.training_env)

    def _on_step(self) -> bool:
        ended = np.flatnonzero(self.locals["dones"]).tolist()
        if ended:
            infos = self.locals["infos"]
            self._late.extend(episode_tags(infos[index], self._metrics) for index in ended)
            for tag, mean in mean_tags(self._late).items():
                self.logger.record(tag, mean)
        return True
