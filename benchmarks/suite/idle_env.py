"""Environments for Stable-Baselines3 that do nothing: what its training costs whatever the simulator."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv, VecMonitor, VecNormalize
from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvStepReturn


class IdleVecEnv(VecEnv):
    """Returns the same arrays at every step; no episode ends.

    Args:
        num_envs: how many.
        observation_space: of each.
        action_space: of each.
    """

    def __init__(
        self, num_envs: int, observation_space: gym.Space[Any], action_space: gym.Space[Any]
    ) -> None:
        super().__init__(num_envs, observation_space, action_space)
        rng = np.random.default_rng(0)
        self._observations = rng.normal(size=(num_envs, *observation_space.shape)).astype(np.float32)
        self._rewards = rng.normal(size=num_envs).astype(np.float32)
        self._dones = np.zeros(num_envs, np.bool_)
        self._infos: list[dict[str, Any]] = [{} for _ in range(num_envs)]

    def reset(self) -> NDArray[np.float32]:
        """Return the observations."""
        return self._observations

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take actions and leave them."""

    def step_wait(self) -> VecEnvStepReturn:
        """Return what there is."""
        return self._observations, self._rewards, self._dones, self._infos

    def close(self) -> None:
        """There is nothing to close."""

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Return nothing for each environment."""
        return [None for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set nothing."""

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call nothing."""
        return self.get_attr(method_name, indices)

    def env_is_wrapped(self, wrapper_class: type[gym.Wrapper], indices: VecEnvIndices = None) -> list[bool]:
        """No environment is wrapped."""
        return [False for _ in self._get_indices(indices)]


def idle_likeness(envs: VecNormalize) -> VecNormalize:
    """Return as many idle environments of the same spaces, in the wrappers that training uses."""
    idle = IdleVecEnv(envs.num_envs, envs.venv.observation_space, envs.venv.action_space)
    return VecNormalize(
        VecMonitor(idle),
        norm_obs=envs.norm_obs,
        norm_reward=envs.norm_reward,
        clip_obs=envs.clip_obs,
        clip_reward=envs.clip_reward,
        gamma=envs.gamma,
    )
