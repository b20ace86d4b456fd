"""Stable-Baselines3's vector environment, around the one whose environments are stepped together in SIMD lanes."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from dq_marine.agents.evaluation.metrics import reward_term_names
from dq_marine.agents.training.vector_wrappers import check_ends, checked_wrappers
from dq_marine.envs.vector.vector_env import MarineVectorEnv
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.vec_env import VecEnv
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn


class MarineVecEnv(VecEnv):
    """What `DummyVecEnv` is for single environments, at the speed of the vector environment.

    Where an episode ends, the info has all that a single environment's has, with `terminal_observation` and
    `TimeLimit.truncated`. The info of an environment that goes on has only what wrappers add to a step's infos, and not
    to a reset's; and of a task with goals the terms of the reward, which hindsight replay needs.

    Gymnasium's wrappers around the vector environment act on observations, rewards, actions, spaces and infos. A
    wrapper that changes observations has to change `infos["final_obs"]`, too. `get_attr`, `set_attr` and `env_method`
    reach the environments inside the wrappers.

    Attributes:
        envs: the vector environment with its wrappers, as it was given.
        marine: the vector environment inside its wrappers.
    """

    actions: NDArray[Any]

    def __init__(self, envs: gym.vector.VectorEnv[Any, Any, Any]) -> None:
        """Wrap a vector environment.

        Args:
            envs: as `gym.make_vec(id, num_envs, autoreset_mode="SameStep")` makes it, in Gymnasium's vector wrappers
                or without.

        Raises:
            InvalidInputError: it is not one of this package, its autoreset mode is another, or a wrapper cannot act
                here; the message says which, and what to take instead.
        """
        inner = envs.unwrapped
        if not isinstance(inner, MarineVectorEnv):
            raise InvalidInputError(
                f"{envs} is not a vector environment of dq_marine; make one with gym.make_vec"
            )
        if inner.autoreset_mode is not AutoresetMode.SAME_STEP:
            raise InvalidInputError(
                f"autoreset_mode = {inner.autoreset_mode.value!r}; Stable-Baselines3 wants environments made with "
                'autoreset_mode="SameStep"'
            )
        self._wrappers = checked_wrappers(envs)
        self.envs: Any = envs  # Gymnasium's types know of one seed for all, and of pictures of all kinds
        self.marine = inner
        super().__init__(inner.num_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata = envs.metadata
        self._started = False
        self._names_at_reset: frozenset[str] = frozenset()

    def reset(self) -> VecEnvObs:
        """Start an episode in every environment, with the seeds and options set before; they are used once."""
        observations: VecEnvObs
        seeds, options = self._seeds, self._options
        alike = all(given == options[0] for given in options) if _comparable(options) else False
        if alike or not self._started:
            observations, infos = self.envs.reset(seed=seeds, options=options[0] if alike else None)
            self.reset_infos = _infos_at(infos, range(self.num_envs))
            self._names_at_reset = frozenset(infos)
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
        added: dict[str, Any] = {}
        if self._wrappers:
            check_ends(dones, infos, self.observation_space)
            added = self._added_by_wrappers(infos)
        reported = self._reported(infos)
        ended = np.flatnonzero(dones).tolist()
        if ended:
            ends = _infos_at(infos["final_info"], ended)
            begun = _infos_at(infos, ended, without=("final_obs", "final_info", *added))
            for index, report, next_info in zip(ended, ends, begun, strict=True):
                report["TimeLimit.truncated"] = bool(truncated[index] and not terminated[index])
                report["terminal_observation"] = infos["final_obs"][index]
                reported[index] = report
                self.reset_infos[index] = next_info
        if added:
            holders = self._holders(added)
            for index, own in zip(holders, _infos_at(added, holders), strict=True):
                reported[index] |= own
        return observations, np.array(rewards, dtype=np.float32), dones, reported

    def close(self) -> None:
        """Close the environments."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Return an attribute of the environments inside the wrappers."""
        return [self.marine.attribute_at(index, attr_name) for index in self._indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute of the environments; episodes that begin later follow it."""
        self.marine.set_attribute_at(self._indices(indices), attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the environments; what it changes is kept."""
        return [
            self.marine.call_at(index, method_name, *method_args, **method_kwargs)
            for index in self._indices(indices)
        ]

    def env_is_wrapped(self, wrapper_class: type[gym.Wrapper], indices: VecEnvIndices = None) -> list[bool]:
        """Return whether a wrapper of this class is around the environments: around all of them or none."""
        found = any(isinstance(wrapper, wrapper_class) for wrapper in self._wrappers)
        return [found for _ in self._indices(indices)]

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

    def _reported(self, infos: dict[str, Any]) -> list[dict[str, Any]]:
        """Return what is told of environments that go on: of a task with goals, what hindsight replay needs."""
        if not self.marine.single.definition.has_goals:
            return [{} for _ in range(self.num_envs)]
        terms = {name: infos[name] for name in reward_term_names(infos)}
        return _infos_at(terms, range(self.num_envs))

    def _added_by_wrappers(self, infos: dict[str, Any]) -> dict[str, Any]:
        """Return what wrappers added in this step; what infos have at a reset, too, tells of the episode begun."""
        names = infos.keys() - self._names_at_reset - _OF_ENDS
        return {name: infos[name] for name in infos if name in names} if names else {}

    def _holders(self, infos: dict[str, Any]) -> list[int]:
        """Return the environments of which infos say anything."""
        every = np.ones(self.num_envs, np.bool_)
        masks = [infos.get(f"_{name}", every) for name in infos if not name.startswith("_")]
        return np.flatnonzero(np.any(masks, axis=0)).tolist() if masks else []

    def _reset_one_by_one(self, seeds: list[int | None], options: list[dict[str, Any]]) -> VecEnvObs:
        """Reset every environment with options of its own."""
        observations: VecEnvObs
        for index in range(self.num_envs):
            mask = np.zeros(self.num_envs, np.bool_)
            mask[index] = True
            observations, infos = self.envs.reset(seed=seeds, options={**options[index], "reset_mask": mask})
            self.reset_infos[index] = _infos_at(infos, [index])[0]
        return observations


def _comparable(options: list[dict[str, Any]]) -> bool:
    """Whether options are one object, or hold nothing: others are not compared, arrays in them would not be."""
    return all(given is options[0] or given == {} == options[0] for given in options)


_OF_ENDS = frozenset({"final_obs", "final_info", "_final_obs", "_final_info"})
"""What the vector environment adds to the infos of a step in which an episode has ended."""


def _infos_at(
    infos: dict[str, Any], indices: Sequence[int], without: Iterable[str] = ()
) -> list[dict[str, Any]]:
    """Return what Gymnasium's merged infos have of some environments, each as a single one has it.

    Gymnasium says in a mask beside each entry which environments have it; in the dictionaries that its wrappers add,
    such as the statistics of an episode, there is none, and all have it. Numbers keep NumPy's types.
    """
    reports: list[dict[str, Any]] = [{} for _ in indices]
    for name, values in infos.items():
        if name.startswith("_") or name in without:
            continue
        mask = infos.get(f"_{name}")
        inner = isinstance(values, dict)
        parts: list[Any] = _infos_at(values, indices) if inner else list(values[list(indices)])
        for index, report, part in zip(indices, reports, parts, strict=True):
            if mask is None or mask[index]:
                report[name] = part
    return reports
