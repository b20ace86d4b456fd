"""What the tests of vector environments share: Gymnasium's own beside ours, actions, and exact comparison."""

from __future__ import annotations

from functools import partial

import gymnasium as gym
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from support.environments import STATION_KEEPING

BUSY = {"max_episode_steps": 7, "workspace_radius": 2.05, "current": 1.0}
"""Episodes so short and starts so near the edge that episodes end all the time, in both ways."""

same = partial(data_equivalence, exact=True)
"""Whether two nested results are equal to the last bit, types included."""


def reference(count, mode=AutoresetMode.NEXT_STEP, **keywords):
    """Return Gymnasium's own vector environment of `count` single ones."""
    make = partial(gym.make, STATION_KEEPING, disable_env_checker=True, **keywords)
    return SyncVectorEnv([make] * count, autoreset_mode=mode)


def states(envs):
    """Return the states of all environments."""
    return envs.call("get_state")
