"""Stable-Baselines3's wrappers and learners see no difference between our environments and its own `DummyVecEnv`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.vec_env import (
    VecEnv,
    VecFrameStack,
    VecMonitor,
    VecNormalize,
    sync_envs_normalization,
)
from support import sb3_envs
from support.equivalence import same
from support.sb3_envs import actions_for, assert_same_step
from support.vector_envs import BUSY

ID = "dq_marine/StationKeeping-v0"


marine, dummy = partial(sb3_envs.marine, **BUSY), partial(sb3_envs.dummy, **BUSY)
BOTH = [marine, dummy]


WRAPPERS: dict[str, Callable[[VecEnv], VecEnv]] = {
    "monitored": VecMonitor,
    "normalised": VecNormalize,
    "stacked": partial(VecFrameStack, n_stack=2),
    "both": lambda envs: VecNormalize(VecMonitor(envs)),
}


@pytest.mark.parametrize("name", WRAPPERS)
def test_wrappers_see_no_difference(name: str) -> None:
    ours, theirs = (WRAPPERS[name](made) for made in (marine(3), dummy(3)))
    for envs in (ours, theirs):
        envs.seed(2)
    assert same(ours.reset(), theirs.reset())
    episodes = 0
    for actions in actions_for(3, 60):
        result, expected = ours.step(actions), theirs.step(actions)
        for info in (*result[3], *expected[3]):
            episodes += info.get("episode", {}).pop("t", None) is not None
        assert_same_step(result, expected)
    assert episodes > 40 or name in ("normalised", "stacked")


def test_a_monitor_writes_measures_of_every_end(tmp_path: Path) -> None:
    file = tmp_path / "monitor.csv"
    envs = VecMonitor(marine(3), str(file), info_keywords=("is_success", "position_error"))
    envs.seed(0)
    envs.reset()
    ends = sum(envs.step(actions)[2].sum() for actions in actions_for(3, 40))
    envs.close()
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[1] == "r,l,t,is_success,position_error"
    assert len(lines) == 2 + ends
    assert all(len(line.split(",")) == 5 for line in lines[1:])


def test_normalisation_is_saved_and_carried_over(tmp_path: Path) -> None:
    envs = VecNormalize(marine(3))
    envs.seed(0)
    envs.reset()
    for actions in actions_for(3, 20):
        envs.step(actions)
    envs.save(str(tmp_path / "normalisation"))
    loaded = VecNormalize.load(str(tmp_path / "normalisation"), marine(3))
    synced = VecNormalize(marine(3))
    sync_envs_normalization(envs, synced)
    for other in (loaded, synced):
        other.training = False
        other.seed(9)
    first = loaded.reset()
    assert same(first, synced.reset())
    envs.training = False
    envs.seed(9)
    assert same(first, envs.reset())


class Steady:
    """A policy that needs no learning: half of what it sees, bounded."""

    def predict(self, observation: np.ndarray, **_: Any) -> tuple[np.ndarray, None]:
        return np.tanh(0.5 * observation[:, :6]), None


@pytest.mark.parametrize("episodes", [2, 7])
def test_evaluations_agree(episodes: int) -> None:
    results = []
    for make in BOTH:
        envs = VecMonitor(make(3))
        envs.seed(3)
        returns, lengths = evaluate_policy(
            Steady(), envs, n_eval_episodes=episodes, return_episode_rewards=True
        )
        assert len(lengths) == episodes
        results.append((returns, lengths))
    assert results[0] == results[1]


def model_of(algorithm: str, envs: VecEnv) -> PPO | SAC:
    common: dict[str, Any] = {"seed": 3, "device": "cpu", "policy_kwargs": {"net_arch": [8]}}
    if algorithm == "ppo":
        return PPO("MlpPolicy", envs, n_steps=16, batch_size=32, n_epochs=2, **common)
    return SAC("MlpPolicy", envs, buffer_size=500, learning_starts=40, batch_size=16, **common)


def weights(model: PPO | SAC) -> list[np.ndarray]:
    return [value.detach().numpy().copy() for value in model.policy.state_dict().values()]


@pytest.mark.parametrize("algorithm", ["ppo", "sac"])
def test_what_is_learned_is_the_same(algorithm: str) -> None:
    """Weights agree to the last bit: episodes' ends, time limits and seeds are understood alike."""
    learned = []
    for make in BOTH:
        model = model_of(algorithm, VecNormalize(VecMonitor(make(4))))
        before = weights(model)
        model.learn(200)
        assert model.ep_info_buffer
        assert model.ep_success_buffer
        assert not same(weights(model), before)
        learned.append((weights(model), list(model.ep_success_buffer), model.num_timesteps))
    assert same(*learned)


@pytest.mark.parametrize("algorithm", ["ppo", "sac"])
def test_a_saved_model_goes_on_learning(tmp_path: Path, algorithm: str) -> None:
    envs = marine(4)
    model = model_of(algorithm, envs)
    model.learn(128)
    model.save(tmp_path / "model")
    loaded = type(model).load(tmp_path / "model", env=marine(4), device="cpu")
    assert same(weights(loaded), weights(model))
    observations = envs.reset()
    assert same(
        loaded.predict(observations, deterministic=True)[0],
        model.predict(observations, deterministic=True)[0],
    )
    loaded.learn(64, reset_num_timesteps=False)
    assert loaded.num_timesteps == model.num_timesteps + 64
