"""What is logged of episodes: whatever metrics and reward terms their infos have."""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, VectorEnv

from dq_marine.agents.evaluation.metrics import Metric
from dq_marine.agents.training.episode_log import episode_tags, mean_tags
from dq_marine.agents.training.reward_sums import RewardSums
from dq_marine.agents.training.vec_env import MarineVecEnv

COUNT = 3


def made() -> MarineVecEnv:
    envs: VectorEnv[Any, Any, Any] = gym.make_vec(
        "dq_marine/StationKeeping-v0",
        num_envs=COUNT,
        autoreset_mode=AutoresetMode.SAME_STEP,
        max_episode_steps=7,
        workspace_radius=2.05,
        current=1.0,
    )
    learned_in = MarineVecEnv(RewardSums(envs))
    learned_in.seed(0)
    learned_in.reset()
    return learned_in


def sum_of_terms(info: dict[str, Any]) -> float:
    terms = {name for name in info if name.startswith("reward/")}
    sums = {name: value for name, value in info.items() if name.startswith("episode_reward/")}
    assert {f"episode_{name}" for name in terms} == set(sums)
    assert len(sums) > 1
    return sum(sums.values())


def test_the_sums_of_all_terms_are_the_return_of_each_episode() -> None:
    envs, returns, ends = made(), np.zeros(COUNT), 0
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (60, COUNT, 6))
    for period, action in enumerate(actions):
        _, rewards, dones, infos = envs.step(action)
        returns += rewards
        for index in range(COUNT):
            assert bool(infos[index]) == dones[index]
            if dones[index]:
                assert sum_of_terms(infos[index]) == pytest.approx(returns[index], rel=1e-5, abs=1e-6)
                returns[index], ends = 0.0, ends + 1
        if period == 30:
            envs.reset()
            returns[:] = 0.0
    assert ends > 10


def test_each_sum_is_that_of_its_own_term() -> None:
    """Told by the effort, the only term that is negative."""
    envs = made()
    expected = np.zeros(COUNT)
    for _ in range(7):
        vector_infos = envs.envs.step(np.full((COUNT, 6), 0.5))[-1]
        ended = vector_infos.get("_final_info", np.zeros(COUNT, np.bool_))
        now = np.where(
            ended,
            vector_infos["final_info"]["reward/effort"] if ended.any() else 0.0,
            vector_infos["reward/effort"],
        )
        expected += now
        for index in np.flatnonzero(ended):
            assert vector_infos["episode_reward/effort"][index] == pytest.approx(expected[index])
            assert expected[index] < 0.0
            expected[index] = 0.0
    assert ended.any()


def test_a_reset_of_some_begins_their_sums_anew() -> None:
    envs = made()
    returns = np.zeros(COUNT)
    for _ in range(2):
        returns += envs.step(np.zeros((COUNT, 6)))[1]
    envs.envs.reset(options={"reset_mask": np.array([False, True, False])})
    returns[1] = 0.0
    seen = set()
    for _ in range(8):
        _, rewards, dones, infos = envs.step(np.zeros((COUNT, 6)))
        returns += rewards
        for index in np.flatnonzero(dones).tolist():
            if index not in seen:
                assert sum_of_terms(infos[index]) == pytest.approx(returns[index], rel=1e-5, abs=1e-6)
            seen.add(index)
    assert seen == {0, 1, 2}


def test_tags_name_metrics_units_and_rates() -> None:
    info = {
        "depth_error": 0.5,
        "tilt": math.pi,
        "laps": 2.0,
        "reward/near": 0.1,
        "episode_reward/near": 12.0,
        "is_success": True,
        "refused": False,
        "TimeLimit.truncated": True,
        "vehicle": 3,
        "episode": {"r": 1.0},
        "terminal_observation": np.zeros(3),
    }
    metrics = (Metric("depth_error", "m"), Metric("tilt", "rad"), Metric("laps"))
    assert episode_tags(info, metrics) == {
        "episode_end/depth_error_m": 0.5,
        "episode_end/tilt_deg": pytest.approx(180.0),
        "episode_end/laps": 2.0,
        "episode_reward/near": 12.0,
        "episode_end/success_rate": 1.0,
        "episode_end/refused_rate": 0.0,
    }


def test_means_are_over_the_episodes_that_have_a_tag() -> None:
    assert mean_tags([{"a": 1.0, "b": 2.0}, {"a": 3.0}]) == {"a": 2.0, "b": 2.0}
    assert mean_tags([]) == {}
