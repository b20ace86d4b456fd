"""What the tests of Stable-Baselines3's environments share: its own beside ours, actions, and exact comparison."""

from __future__ import annotations

from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
from stable_baselines3.common.vec_env import DummyVecEnv, VecEnv

from dq_marine.agents.training.vec_env import MarineVecEnv
from support.environments import STATION_KEEPING
from support.equivalence import same


def marine(count: int, **keywords: Any) -> VecEnv:
    """Return environments that are stepped together."""
    return MarineVecEnv(gym.make_vec(STATION_KEEPING, num_envs=count, autoreset_mode="SameStep", **keywords))


def dummy(count: int, **keywords: Any) -> VecEnv:
    """Return Stable-Baselines3's own vector environment of single ones."""
    return DummyVecEnv([partial(gym.make, STATION_KEEPING, disable_env_checker=True, **keywords)] * count)


def actions_for(count: int, periods: int, scale: float = 1.0) -> np.ndarray:
    """Return random actions, shape (periods, count, 6)."""
    return np.random.default_rng(0).uniform(-scale, scale, (periods, count, 6)).astype(np.float32)


def assert_same_step(ours: Any, theirs: Any) -> None:
    """Infos of episodes that go on may be left out, whole or in part."""
    for name, own, expected in zip(("observations", "rewards", "dones"), ours, theirs, strict=False):
        assert same(own, expected), f"{name}: {own}, not {expected}"
    assert isinstance(ours[3], list)
    for own, expected, done in zip(ours[3], theirs[3], ours[2], strict=True):
        if done:
            assert same(own, expected), f"{own}, not {expected}"
        else:
            assert all(same(value, expected[key]) for key, value in own.items())
