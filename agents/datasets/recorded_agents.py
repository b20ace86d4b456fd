"""Episodes that agents fly, kept as one Minari dataset for each agent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.datasets.dataset_folder import DatasetFolder
from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.evaluation import Score, evaluate
from dq_marine.agents.noise import with_noise
from dq_marine.checks import finite_number
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation


class Disturbed:
    """An agent whose actions are disturbed: what it flies tells what actions other than its own would lead to."""

    def __init__(self, agent: Agent, noise: float, seed: int) -> None:
        """Take the noise's standard deviation, of actions between -1 and 1, and the seed of all that is drawn."""
        self._agent, self._noise = agent, noise
        self._random = np.random.default_rng(seed)

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Prepare the agent; the noise goes on."""
        self._agent.reset(env)

    def act(self, observation: Observation) -> Action:
        """Return the agent's action with its noise."""
        return with_noise(self._agent.act(observation), self._noise, self._random)


def record_agents(
    env: gym.Env[Any, Any],
    agents: Mapping[str, Agent],
    folder: DatasetFolder,
    *,
    episodes: int,
    seed: int,
    noise: float = 0.0,
    after_episode: Callable[[str, Episode], None] | None = None,
) -> list[Score]:
    """Fly the same seeded episodes with each agent, and keep them; those flown are kept, too, where it is interrupted.

    Args:
        env: made with a time limit.
        agents: by name.
        folder: where each becomes a dataset, called by task, vehicle and agent.
        episodes: of each agent, at least 1.
        seed: of the first episode, and of the noise.
        noise: the standard deviation of what is added to actions, which are between -1 and 1.
        after_episode: called with the agent's name and the episode after each one.

    Raises:
        InvalidInputError: the noise is negative or no number, or the folder cannot be written.
    """
    noise = finite_number("noise", noise, least=0.0)
    scores = []
    for name, agent in agents.items():
        recorded = folder.recording(env, lambda stepped: {})
        try:
            scores += evaluate(
                recorded,
                {name: Disturbed(agent, noise, seed)},
                episodes=episodes,
                seed=seed,
                after_episode=after_episode,
            )
        finally:
            folder.keep(
                recorded,
                agent=name,
                algorithm=f"{name}, actions disturbed by {noise:g}" if noise else name,
                description=f"flown by dq-marine's agent {name}; noise of standard deviation {noise:g} in its actions",
            )
    return scores
