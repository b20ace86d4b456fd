"""Solids in environments: felt, drawn, alone and in lanes, before and after an environment travels."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import dq_marine  # noqa: F401 - registers the tasks
from dq_marine.task.things import Column, Relief

KEYWORDS = {
    "solids": [
        {"kind": "plane", "position_ned": [0.0, 0.0, 6.5]},
        {"kind": "pillar", "radius": 0.4, "position_ned": [0.8, 0.3, 0.0], "friction": 0.2},
    ],
    "current": [0.1, 0.0, 0.0],
    "max_episode_steps": 80,
}
STATION_KEEPING = "dq_marine/StationKeeping-v0"


def test_solids_are_drawn_where_they_are():
    env = gym.make(STATION_KEEPING, **KEYWORDS)
    env.reset(seed=1)
    things = env.unwrapped.snapshot().things
    assert [type(thing.form) for thing in things] == [Relief, Column]
    assert [thing.position_ned for thing in things] == [(0.0, 0.0, 6.5), (0.8, 0.3, 0.0)]
    assert pickle.loads(pickle.dumps(env.unwrapped.settings)) == env.unwrapped.settings


@pytest.mark.sweep
def test_lanes_are_single_environments_in_contact_and_no_hull_goes_through():
    count = 9
    many = gym.make_vec(STATION_KEEPING, num_envs=count, **KEYWORDS)
    singles = [gym.make(STATION_KEEPING, **KEYWORDS) for _ in range(count)]
    observed, _ = many.reset(seed=3)
    for k, env in enumerate(singles):
        assert np.array_equal(env.reset(seed=3 + k)[0], observed[k])
    rng, deepest = np.random.default_rng(2), 0.0
    for _ in range(79):
        actions = rng.uniform(-1.0, 1.0, many.action_space.shape).astype(np.float32)
        actions[:, 2] = 0.8  # down, to the seabed
        observed, rewards, *_ = many.step(actions)
        for k, env in enumerate(singles):
            seen, reward, *_ = env.step(actions[k])
            assert np.array_equal(seen, observed[k])
            assert reward == rewards[k]
            deepest = max(deepest, float(env.unwrapped.snapshot().position_ned[2]))
    assert 6.2 < deepest < 6.5  # its keel is on the seabed, not beyond
