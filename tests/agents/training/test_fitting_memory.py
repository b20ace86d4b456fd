"""A policy with a memory that is fitted to what a teacher did: what it remembers goes on from piece to piece."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize
from support.trainings import tiny

from dq_marine.agents.settings import ImitationSettings, NetworkSettings, TrainingSettings
from dq_marine.agents.training.fitting import fit_steps
from dq_marine.agents.training.fitting_memory import STREAMS, _Fitted, fit_episodes, pieces
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.learners import environments_of, make_model
from dq_marine.agents.training.recurrent_decision import RememberingPupil
from dq_marine.agents.training.teaching import Lessons, taught


@given(st.lists(st.integers(1, 60), min_size=1, max_size=40), st.integers(1, 25), st.randoms())
def test_pieces_have_every_period_of_every_episode_once_and_in_order(
    lengths: list[int], periods: int, random: Any
) -> None:
    episodes = random.sample(range(len(lengths)), random.randint(1, len(lengths)))
    first = np.cumsum([0, *lengths])
    streams: list[list[int]] = [[] for _ in range(STREAMS)]
    begun = 0
    for piece in pieces(np.array(lengths), np.array(episodes), periods):
        assert piece.rows.shape == piece.flown.shape == (periods, STREAMS)
        for index, stream in enumerate(streams):
            rows = piece.rows[piece.flown[:, index], index].tolist()
            if rows:
                starts = rows[0] in first
                assert piece.begins[index] == float(starts)
                assert starts or rows[0] == stream[-1] + 1  # else it goes on where the piece before has ended
                assert rows == list(range(rows[0], rows[0] + len(rows)))
                begun += starts
            stream += rows
    assert begun == len(episodes)
    expected = [row for one in episodes for row in range(first[one], first[one + 1])]
    assert sorted(row for stream in streams for row in stream) == sorted(expected)


def recurrent(tmp_path: Path, own: ImitationSettings) -> TrainingSettings:
    settings = tiny(tmp_path, "recurrent_ppo", 64)
    algorithm = settings.algorithm.model_copy(update={"lstm_hidden_size": 32, "gamma": 0.7})
    wide = NetworkSettings(layers=(32,), activation="tanh")
    return settings.model_copy(update={"imitation": own, "algorithm": algorithm, "network": wide})


def test_what_is_remembered_goes_on_from_piece_to_piece_as_in_flight(tmp_path: Path) -> None:
    own = ImitationSettings(episodes=2, noise=0.3)
    settings = recurrent(tmp_path, own)
    model = make_model(settings, 3, tmp_path)
    with torch.no_grad():
        model.policy.lstm_actor.weight_hh_l0.mul_(5.0)
        model.policy.action_net.weight.mul_(50.0)
    envs = model.get_vec_normalize_env()
    lessons = taught(settings, own, np.random.default_rng(0))
    fitted, both = _Fitted(model.policy, envs, lessons), np.array([0, 1])
    pupil, acted = RememberingPupil(model.policy, envs), []
    row = 0
    for length in lessons.lengths:
        pupil.reset(None)  # type: ignore[arg-type]
        acted += [pupil.act(one) for one in lessons.observations[row : row + length]]
        row += length
    assert np.abs(acted).max() < 1.0  # beyond which a pupil is held, and what is fitted is not
    off = float(np.mean(np.square(np.array(acted) - lessons.actions)))
    for periods in (7, 50, 5000):
        assert fitted.missed(both, periods) == pytest.approx(off, rel=1e-4)
    environments_of(model).close()


def remembering(rng: np.random.Generator, episodes: int = 64, length: int = 30) -> Lessons:
    """Return what only a memory can learn: the first number that is observed is the action of all periods."""
    told = rng.uniform(-0.8, 0.8, episodes)
    observations = np.zeros((episodes, length, 3), np.float32)
    observations[:, :, 1] = rng.normal(size=(episodes, length))
    observations[:, 0, 0] = told
    actions = np.repeat(told, length).astype(np.float32)[:, None]
    unknown = np.full(episodes * length, np.nan)
    lengths, estimates = np.full(episodes, length), np.zeros((episodes * length, 0), np.float32)
    nothing, ends, cut_off = np.zeros(episodes * length), observations[:, -1], np.zeros(episodes, bool)
    seen = observations.reshape(-1, 3)
    return Lessons(seen, actions, unknown, nothing, lengths, estimates, actions, nothing, ends, cut_off)


class Spaces(gym.Env[Any, Any]):
    """An environment of three numbers and one action, which is only there for its spaces."""

    observation_space = gym.spaces.Box(-10.0, 10.0, (3,), np.float32)
    action_space = gym.spaces.Box(-1.0, 1.0, (1,), np.float32)


def test_a_memory_learns_what_was_told_once() -> None:
    envs = VecNormalize(DummyVecEnv([Spaces]), norm_obs=False, norm_reward=False)
    lessons = remembering(np.random.default_rng(1))
    spread = float(np.mean(np.square(lessons.actions)))
    own = ImitationSettings(epochs=150, batch_size=STREAMS * 10, learning_rate=1e-2)
    network: dict[str, Any] = {"net_arch": [16]}
    model = RecurrentPPO(
        "MlpLstmPolicy", envs, seed=0, device="cpu", policy_kwargs={**network, "lstm_hidden_size": 8}
    )
    missed = fit_episodes(model.policy, envs, lessons, own, np.random.default_rng(2))
    forgetful = PPO("MlpPolicy", envs, seed=0, device="cpu", policy_kwargs=network)
    missed_without = fit_steps(forgetful.policy, envs, lessons, own, np.random.default_rng(2))
    assert missed < 0.05 * spread
    assert missed_without > 0.6 * spread


def test_it_copies_the_teacher_and_its_critic_knows_what_that_earns(tmp_path: Path) -> None:
    own = ImitationSettings(
        episodes=20, epochs=40, batch_size=STREAMS * 5, learning_rate=3e-3, rounds=1, turns=10
    )
    settings = recurrent(tmp_path, own)
    model = make_model(settings, 3, tmp_path)
    missed = imitate(model, settings, 3)
    lessons = taught(settings, own, np.random.default_rng(8))
    assert missed < 0.5 * float(np.mean(np.square(lessons.actions)))
    envs = model.get_vec_normalize_env()
    observations, _ = model.policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    nothing = 2 * (torch.zeros(1, 1, 32),)
    off, spread = [], []
    for episode in np.arange(len(lessons.actions)).reshape(20, 30):
        with torch.no_grad():
            values = model.policy.predict_values(observations[episode], nothing, torch.zeros(30)).numpy()
        returns = lessons.returns[episode] / np.sqrt(envs.ret_rms.var + envs.epsilon)
        known = np.isfinite(returns)
        assert 15 < known.sum() < 30
        off.append(values[known, 0] - returns[known])
        spread.append(returns[known])
    assert np.mean(np.square(off)) < 0.3 * np.var(spread)
    environments_of(model).close()


def test_the_memory_holds_what_the_teacher_has_found_out_though_no_action_needs_it() -> None:
    envs = VecNormalize(DummyVecEnv([Spaces]), norm_obs=False, norm_reward=False)
    lessons = remembering(np.random.default_rng(1))
    told = lessons.actions.copy()
    own = ImitationSettings(epochs=60, batch_size=STREAMS * 10, learning_rate=1e-2)
    network: dict[str, Any] = {"net_arch": [16], "lstm_hidden_size": 8}
    missed = {}
    for name, estimates in (("told", told), ("not told", np.zeros((len(told), 0), np.float32))):
        model = RecurrentPPO("MlpLstmPolicy", envs, seed=0, device="cpu", policy_kwargs=network)
        given = replace(lessons, actions=np.zeros_like(told), estimates=estimates)
        fit_episodes(model.policy, envs, given, own, np.random.default_rng(2))
        with torch.no_grad():
            rows = torch.as_tensor(lessons.observations.reshape(-1, 30, 3)).swapaxes(0, 1)
            memory = model.policy.lstm_actor(rows)[0][-1].numpy()
        ends = told.reshape(-1, 30)[:, -1]
        with_one = np.column_stack([memory, np.ones(len(memory))])
        guessed = with_one @ np.linalg.lstsq(with_one, ends, rcond=None)[0]
        missed[name] = float(np.mean(np.square(guessed - ends)) / np.mean(np.square(ends)))
    assert missed["told"] < 0.1
    assert missed["not told"] > 3.0 * missed["told"]


@pytest.mark.parametrize("algorithm", ["ppo", "recurrent_ppo"])
def test_a_single_episode_is_learned_from_and_rounds_in_which_the_teacher_never_flies_are_no_harm(
    algorithm: str, tmp_path: Path
) -> None:
    own = ImitationSettings(episodes=1, epochs=2, rounds=1, turns=10**9)
    settings = tiny(tmp_path, algorithm, 64).model_copy(update={"imitation": own})
    model = make_model(settings, 3, tmp_path)
    before = model.policy.action_net.weight.detach().clone()
    assert 0.0 < imitate(model, settings, 3) < 1.0
    assert not torch.equal(model.policy.action_net.weight, before)
    environments_of(model).close()
    alone = settings.model_copy(update={"imitation": ImitationSettings(episodes=1, epochs=2)})
    model = make_model(alone, 3, tmp_path)
    assert 0.0 < imitate(model, alone, 3) < 1.0
    assert not torch.equal(model.policy.action_net.weight, before)
    environments_of(model).close()
