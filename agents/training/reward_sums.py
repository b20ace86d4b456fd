"""Sums of an episode's reward terms, put into the info of its end."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorWrapper
from numpy.typing import NDArray

from dq_marine.agents.evaluation.metrics import REWARD_PREFIX, reward_term_names

SUM_PREFIX = "episode_reward/"
"""Of the entries of an end's info that are sums over the episode."""


class RewardSums(VectorWrapper[Any, Any, Any, Any, Any]):
    """Adds up `reward/NAME` over each episode, into `episode_reward/NAME` of the infos where it ends.

    For environments whose ended episodes are followed by new ones in the same step. Where infos have no reward terms,
    nothing is added.
    """

    def __init__(self, envs: gym.vector.VectorEnv[Any, Any, Any]) -> None:
        """Wrap a vector environment."""
        super().__init__(envs)
        self._sums: dict[str, NDArray[np.float64]] = {}

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Reset, and let the sums of these episodes begin at 0."""
        observations, infos = self.env.reset(seed=seed, options=options)
        begun = (options or {}).get("reset_mask", np.ones(self.num_envs, np.bool_))
        for name in reward_term_names(infos):
            self._sums.setdefault(name, np.zeros(self.num_envs))[begun] = 0.0
        return observations, infos

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Step, and put the sums of episodes that ended into the infos."""
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        ended = infos.get("_final_info")
        if ended is None:
            for name, sums in self._sums.items():
                sums += infos[name]
            return observations, rewards, terminated, truncated, infos
        going = ~ended
        for name, sums in self._sums.items():
            np.add(sums, infos[name], out=sums, where=going)
            np.add(sums, infos["final_info"][name], out=sums, where=ended)
            own = SUM_PREFIX + name.removeprefix(REWARD_PREFIX)
            infos[own], infos[f"_{own}"] = np.where(ended, sums, 0.0), ended
            sums[ended] = 0.0
        return observations, rewards, terminated, truncated, infos
