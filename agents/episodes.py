"""Flying one episode and keeping what is worth plotting, tabulating or testing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.environments import marine
from dq_marine.agents.policies import Agent
from dq_marine.errors import InvalidInputError

Array = NDArray[np.float64]

SETTLED_POSITION = 0.05
"""Distance to the goal [m] within which, with `SETTLED_ATTITUDE`, an episode counts as settled."""

SETTLED_ATTITUDE = math.radians(2.0)
"""Attitude error [rad] within which an episode counts as settled."""


@dataclass(frozen=True)
class Episode:
    """One flown episode of n control periods, on n + 1 instants.

    Attributes:
        time: since the start [s], shape (n + 1,).
        position_error: distance to the goal [m], shape (n + 1,).
        attitude_error: angle to the goal's attitude [rad], shape (n + 1,).
        actions: normalised, as held from each instant but the last, shape (n, axes).
        total_reward: the return, undiscounted.
        success: whether the task counts as done at the end.
        ended_early: whether the episode was terminated, say beyond the workspace.
    """

    time: Array
    position_error: Array
    attitude_error: Array
    actions: Array
    total_reward: float
    success: bool
    ended_early: bool

    @property
    def last_third(self) -> slice:
        """The instants from which steady errors are taken."""
        return slice(2 * len(self.time) // 3, None)

    @property
    def settling_time(self) -> float | None:
        """Time from which on both errors stay within the `SETTLED_` limits [s]; None if they do not."""
        outside = (self.position_error > SETTLED_POSITION) | (self.attitude_error > SETTLED_ATTITUDE)
        if outside[-1]:
            return None
        return float(self.time[np.flatnonzero(outside)[-1] + 1]) if outside.any() else 0.0


def fly_episode(
    env: gym.Env[Any, Any],
    agent: Agent,
    *,
    seed: int,
    options: dict[str, Any] | None = None,
    interruptible: bool = False,
) -> Episode:
    """Fly one episode to its end.

    Args:
        env: made with a time limit.
        agent: the pilot.
        seed: of the episode.
        options: of the environment's reset.
        interruptible: whether Ctrl-C ends the flight and keeps what was flown; else it passes.

    Raises:
        InvalidInputError: an option is wrong, or the environment does not measure position and attitude errors.
    """
    observation, info = env.reset(seed=seed, options=options)
    agent.reset(env)
    errors, actions, total_reward = [_errors(info)], [], 0.0
    terminated = truncated = False
    while not (terminated or truncated):
        action = agent.act(observation)
        try:
            observation, reward, terminated, truncated, info = env.step(action)
        except KeyboardInterrupt:
            if not interruptible:
                raise
            break
        errors.append(_errors(info))
        actions.append(action)
        total_reward += float(reward)
    measured = np.array(errors)
    held = np.array(actions, dtype=np.float64).reshape(len(actions), *(env.action_space.shape or ()))
    return Episode(
        time=marine(env).control_period * np.arange(len(errors), dtype=np.float64),
        position_error=measured[:, 0],
        attitude_error=measured[:, 1],
        actions=np.clip(held, -1.0, 1.0),
        total_reward=total_reward,
        success=bool(info["is_success"]),
        ended_early=terminated,
    )


def _errors(info: dict[str, Any]) -> tuple[float, float]:
    try:
        return info["position_error"], info["attitude_error"]
    except KeyError as error:
        raise InvalidInputError(
            f"the environment's info has no {error}; fly one that measures position_error and attitude_error"
        ) from error
