"""Stable-Baselines3's vector environment, around the one whose environments are stepped together in SIMD lanes."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.envs.vector_env import DQMarineVectorEnv
from dq_marine.errors import InvalidInputError
from dq_marine.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.vec_env import VecEnv
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvStepReturn


class MarineVecEnv(VecEnv):
    """What `DummyVecEnv` is for single environments, at the speed of the vector environment.

    Environments that go on have an empty info; where an episode ends, the info has all that a single environment's
    has, with `terminal_observation` and `TimeLimit.truncated`.
    """

    actions: NDArray[Any]

    def __init__(self, envs: gym.vector.VectorEnv[Any, Any, Any]) -> None:
        """Wrap a vector environment.

        Args:
            envs: as `gym.make_vec(id, num_envs, autoreset_mode="SameStep")` makes it.

        Raises:
            InvalidInputError: it is not one of this package, or its autoreset mode is another.
        """
        inner = envs.unwrapped
        if not isinstance(inner, DQMarineVectorEnv):
            raise InvalidInputError(
                f"{envs} is not a vector environment of dq_marine; make one with gym.make_vec"
            )
        if inner.autoreset_mode is not AutoresetMode.SAME_STEP:
            raise InvalidInputError(
                f"autoreset_mode = {inner.autoreset_mode.value!r}; Stable-Baselines3 wants environments made with "
                'autoreset_mode="SameStep"'
            )
        self.envs = inner
        super().__init__(inner.num_envs, inner.single_observation_space, inner.single_action_space)
        self.metadata = inner.metadata
        self._started = False

    def reset(self) -> NDArray[np.float32]:
        """Start an episode in every environment, with the seeds and options set before; they are used once."""
        seeds, options = self._seeds, self._options
        alike = all(given == options[0] for given in options) if _comparable(options) else False
        if alike or not self._started:
            observations, infos = self.envs.reset(seed=seeds, options=options[0] if alike else None)
            self.reset_infos = [_info_at(infos, index) for index in range(self.num_envs)]
        if not alike:
            observations = self._reset_one_by_one(seeds, options)
        self._started = True
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take the actions of `step_wait`."""
        self.actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Return observations, rewards, dones and infos; an ended episode is followed by a new one at once."""
        observations, rewards, terminated, truncated, infos = self.envs.step(self.actions)
        dones = terminated | truncated
        reported: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        if dones.any():
            for index in np.flatnonzero(dones).tolist():
                report = _info_at(infos["final_info"], index)
                report["TimeLimit.truncated"] = bool(truncated[index] and not terminated[index])
                report["terminal_observation"] = infos["final_obs"][index]
                reported[index] = report
                self.reset_infos[index] = _info_at(infos, index, without=("final_obs", "final_info"))
        return observations, rewards.astype(np.float32), dones, reported

    def close(self) -> None:
        """Close the environments."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Return an attribute of the environments."""
        return [self.envs.attribute_at(index, attr_name) for index in self._indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute of the environments; episodes that begin later follow it."""
        self.envs.set_attribute_at(self._indices(indices), attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the environments; what it changes is kept."""
        return [
            self.envs.call_at(index, method_name, *method_args, **method_kwargs)
            for index in self._indices(indices)
        ]

    def env_is_wrapped(self, wrapper_class: type[gym.Wrapper], indices: VecEnvIndices = None) -> list[bool]:
        """No environment is wrapped."""
        return [False for _ in self._indices(indices)]

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """Return a picture of every environment."""
        if self.render_mode != "rgb_array":
            warnings.warn(
                f"render_mode = {self.render_mode!r} has no pictures; make it rgb_array", stacklevel=2
            )
            return [None] * self.num_envs
        return list(self.envs.render() or ())

    def _indices(self, indices: VecEnvIndices) -> list[int]:
        every = range(self.num_envs)
        return [every[index] for index in self._get_indices(indices)]

    def _reset_one_by_one(
        self, seeds: list[int | None], options: list[dict[str, Any]]
    ) -> NDArray[np.float32]:
        """Reset every environment with options of its own."""
        for index in range(self.num_envs):
            mask = np.zeros(self.num_envs, np.bool_)
            mask[index] = True
            observations, infos = self.envs.reset(seed=seeds, options={**options[index], "reset_mask": mask})
            self.reset_infos[index] = _info_at(infos, index)
        return observations


def _comparable(options: list[dict[str, Any]]) -> bool:
    """Whether options are one object, or hold nothing: others are not compared, arrays in them would not be."""
    return all(given is options[0] or given == {} == options[0] for given in options)


def _info_at(infos: dict[str, Any], index: int, without: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return what Gymnasium's merged infos have of one environment, as a single one has it."""
    report: dict[str, Any] = {}
    for name, values in infos.items():
        if name.startswith("_") or name in without or not infos[f"_{name}"][index]:
            continue
        if isinstance(values, dict):
            report[name] = _info_at(values, index)
        else:
            value = values[index]
            report[name] = value.item() if isinstance(value, np.generic) else value
    return report
