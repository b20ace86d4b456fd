"""Registration of the environments with Gymnasium, by name only: their modules are imported by `gym.make`."""

from __future__ import annotations

import gymnasium as gym

NAMESPACE = "dq_marine"


def register_environments() -> None:
    """Register every environment, once."""
    name = f"{NAMESPACE}/StationKeeping-v0"
    if name not in gym.registry:
        gym.register(
            id=name,
            entry_point="dq_marine.envs.station_keeping:StationKeepingEnv",
            vector_entry_point="dq_marine.envs.station_keeping:StationKeepingVectorEnv",
            max_episode_steps=300,
        )
