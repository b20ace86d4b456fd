"""Which of Gymnasium's wrappers around a vector environment can act where Stable-Baselines3 learns."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorObservationWrapper, VectorWrapper
from gymnasium.wrappers.vector import DictInfoToList, VectorizeTransformObservation
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError


def checked_wrappers(
    envs: gym.vector.VectorEnv[Any, Any, Any],
) -> tuple[gym.vector.VectorEnv[Any, Any, Any], ...]:
    """Return the wrappers around a vector environment, the outermost first.

    Raises:
        InvalidInputError: one of them cannot act where episodes end and begin in the same step, or hands out what
            Stable-Baselines3 does not take; the message names it and what to take instead.
    """
    wrappers = []
    while isinstance(envs, VectorWrapper):
        problem = _problem(envs)
        if problem:
            raise InvalidInputError(
                f"the wrapper {type(envs).__name__} cannot act in MarineVecEnv: {problem}"
            )
        wrappers.append(envs)
        envs = envs.env
    if envs is not envs.unwrapped:
        raise InvalidInputError(
            f"the wrapper {type(envs).__name__} is not a gymnasium.vector.VectorWrapper, so it is unknown what it "
            "changes; derive it from VectorWrapper, or put a VecEnvWrapper of Stable-Baselines3 around MarineVecEnv"
        )
    return tuple(wrappers)


def check_ends(dones: NDArray[np.bool_], infos: dict[str, Any], space: gym.Space[Any]) -> None:
    """Check that wrappers left the ends of episodes as the environments made them.

    Args:
        dones: whether the wrapped environments say that an episode has ended, shape (n,).
        infos: of the step.
        space: of one environment's observations, as the wrappers show them.

    Raises:
        InvalidInputError: a wrapper ends or prolongs episodes, or changes observations but not those that episodes
            end with.
    """
    ended = infos.get("_final_obs")
    if ended is None:
        if not dones.any():
            return
        ended = np.zeros_like(dones)
    if not np.array_equal(ended, dones):
        index = int(np.flatnonzero(ended != dones)[0])
        said, is_so = ("has ended", "goes on") if dones[index] else ("goes on", "has ended")
        raise InvalidInputError(
            f"a wrapper says that the episode of environment {index} {said}, but it {is_so}: wrappers cannot end or "
            "prolong episodes here; set max_episode_steps, or make it part of the task"
        )
    for index in np.flatnonzero(dones).tolist():
        shape = np.shape(infos["final_obs"][index])
        if space.shape is not None and shape != space.shape:
            raise InvalidInputError(
                f"a wrapper changes observations to shape {space.shape}, but not infos['final_obs'], of shape {shape}: "
                "let it change that, too, or put a VecEnvWrapper of Stable-Baselines3 around MarineVecEnv"
            )


def _problem(wrapper: VectorWrapper[Any, Any, Any, Any, Any]) -> str | None:
    """Say why a wrapper cannot act and what to take instead; None if it can."""
    # By name: these classes import jax or torch.
    if any(kind.__name__ == "ArrayConversion" for kind in type(wrapper).__mro__):
        return "Stable-Baselines3 takes NumPy arrays and makes its tensors itself; leave the wrapper out"
    if isinstance(wrapper, DictInfoToList):
        return "MarineVecEnv makes the list of infos itself; leave the wrapper out"
    known = isinstance(wrapper, VectorizeTransformObservation)
    if isinstance(wrapper, VectorObservationWrapper) and not known:
        return (
            "it changes observations, but not those that episodes end with, from which Stable-Baselines3 learns; put "
            "a VecEnvWrapper of its own around MarineVecEnv, such as VecNormalize, or change infos['final_obs'], too, "
            "in a VectorWrapper of yours"
        )
    return None
