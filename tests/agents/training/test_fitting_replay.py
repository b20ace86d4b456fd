"""A policy of an algorithm that learns from a memory begins as a copy, remembers what was flown, and keeps its copy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from rich.console import Console
from support.trainings import REMEMBERING, parameters_of, tiny

from dq_marine.agents.settings import ImitationSettings, NetworkSettings, TrainingSettings
from dq_marine.agents.training.fitting_replay import acted, values
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.keeping import KEPT
from dq_marine.agents.training.learners import environments_of, load_model, make_model, save_model
from dq_marine.agents.training.remembering import remember
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.teaching import taught
from dq_marine.agents.training.training import begin_training, resume_training
from dq_marine.cli.agent_options import EnvironmentOptions, requested_training
from dq_marine.errors import InvalidInputError

ROUND_OFF = 2e-7
"""Of actions in [-1, 1], which are scaled to their range and back in single precision."""

BRIEF = ImitationSettings(episodes=40, epochs=60, batch_size=64, learning_rate=3e-3)


def learning(tmp_path: Path, algorithm: str, own: ImitationSettings = BRIEF) -> TrainingSettings:
    settings = tiny(tmp_path, algorithm, 64)
    wide = NetworkSettings(layers=(32,), activation="relu")
    kind = settings.algorithm.model_copy(update={"gamma": 0.7})
    return settings.model_copy(update={"imitation": own, "network": wide, "algorithm": kind})


def copied(tmp_path: Path, settings: TrainingSettings) -> Any:
    model = make_model(settings, 3, tmp_path)
    imitate(model, settings, 3)
    return model


def doing(model: Any, observations: Any) -> np.ndarray:
    model.policy.set_training_mode(False)
    with torch.no_grad():
        return acted(model.policy.actor, observations)[0].numpy()


@pytest.mark.parametrize("algorithm", REMEMBERING)
def test_the_copy_does_what_the_teacher_does_and_values_what_that_earns(
    algorithm: str, tmp_path: Path
) -> None:
    settings = learning(tmp_path, algorithm)
    model = copied(tmp_path, settings)
    lessons = taught(settings, BRIEF, np.random.default_rng(8))
    seen, _ = model.policy.obs_to_tensor(model.get_vec_normalize_env().normalize_obs(lessons.observations))
    off = float(np.mean(np.square(doing(model, seen) - lessons.actions)))
    assert off < 0.3 * float(np.mean(np.square(lessons.actions)))
    known = np.isfinite(lessons.returns)
    with torch.no_grad():
        told = [one.mean(1).numpy() for one in values(model.policy, seen, torch.as_tensor(lessons.flown))]
        _, log_std = acted(model.policy.actor, seen)
    for one in told:
        assert np.corrcoef(one[known], lessons.returns[known])[0, 1] > 0.9
    if log_std is not None:
        assert float(log_std.exp().mean()) == pytest.approx(BRIEF.noise, rel=0.3)
    for name in ("actor", "critic"):
        if hasattr(model.policy, f"{name}_target"):
            own, slow = getattr(model.policy, name), getattr(model.policy, f"{name}_target")
            for these, those in zip(own.parameters(), slow.parameters(), strict=True):
                assert torch.equal(these, those)
    environments_of(model).close()


@pytest.mark.parametrize("ends_by_itself", [True, False])
def test_what_was_flown_is_remembered_as_it_would_have_been_learned(
    ends_by_itself: bool, tmp_path: Path
) -> None:
    """Each period with what was done, what that earned and what came of it; of a time limit nothing is learned."""
    settings = learning(tmp_path, "sac")
    own = ImitationSettings(episodes=4, noise=0.1)
    lessons = taught(settings, own, np.random.default_rng(0))
    assert len(lessons.rewards) == 4 * 30
    lessons.terminated[:] = ends_by_itself
    model = make_model(settings, 3, tmp_path)
    remember(model, lessons)
    assert model.learning_starts == 0
    buffer, half = model.replay_buffer, 4 * 15
    assert buffer.pos == half

    def in_turn(remembered: np.ndarray) -> np.ndarray:
        return remembered[:half].reshape(4 * 30, *remembered.shape[2:])

    np.testing.assert_array_equal(in_turn(buffer.observations), lessons.observations)
    np.testing.assert_allclose(in_turn(buffer.actions), lessons.flown, rtol=0.0, atol=ROUND_OFF)
    np.testing.assert_array_equal(in_turn(buffer.rewards), lessons.rewards.astype(np.float32))
    last = np.arange(29, 120, 30)
    inside = np.setdiff1d(np.arange(120), last)
    following = in_turn(buffer.next_observations)
    np.testing.assert_array_equal(following[inside], lessons.observations[inside + 1])
    np.testing.assert_array_equal(following[last], lessons.ends)
    np.testing.assert_array_equal(np.flatnonzero(in_turn(buffer.dones)), last)
    np.testing.assert_array_equal(np.flatnonzero(in_turn(buffer.timeouts)), [] if ends_by_itself else last)
    environments_of(model).close()


def test_what_an_episode_ends_with_is_not_what_the_next_begins_with(tmp_path: Path) -> None:
    lessons = taught(
        learning(tmp_path, "sac"), ImitationSettings(episodes=2, noise=0.0), np.random.default_rng(0)
    )
    moved = np.abs(np.diff(lessons.observations[:30], axis=0)).max()
    assert np.abs(lessons.ends[0] - lessons.observations[29]).max() < 3.0 * moved
    assert np.abs(lessons.ends[0] - lessons.observations[30]).max() > 0.1


@pytest.mark.parametrize("algorithm", REMEMBERING)
def test_a_copy_that_is_kept_stays_near_and_one_that_is_not_goes_astray(
    algorithm: str, tmp_path: Path
) -> None:
    strayed = {}
    for keeping in (0.0, 100.0):
        own = BRIEF.model_copy(update={"episodes": 10, "epochs": 10, "keeping": keeping})
        model = copied(tmp_path, learning(tmp_path, algorithm, own))
        seen = model.replay_buffer.sample(200, env=model.get_vec_normalize_env()).observations
        before = doing(model, seen)
        model.learn(400)
        strayed[keeping] = float(np.mean(np.square(doing(model, seen) - before)))
        environments_of(model).close()
    assert strayed[100.0] < 0.5 * strayed[0.0]


def test_the_copy_goes_on_reading_numbers_as_it_learned_to(tmp_path: Path) -> None:
    """Or what it does would drift with the statistics, and with it the policy that is to do the same."""
    model = copied(tmp_path, learning(tmp_path, "td3", BRIEF.model_copy(update={"episodes": 1, "epochs": 1})))
    envs = model.get_vec_normalize_env()
    far = np.full((1, *model.observation_space.shape), 3.0)
    before = envs.normalize_obs(far)
    model.learn(64)
    np.testing.assert_allclose(envs.normalize_obs(far), before, rtol=0.0, atol=1e-9)
    environments_of(model).close()


@pytest.mark.parametrize("algorithm", ["sac", "td3"])
def test_a_copy_is_kept_after_the_model_was_loaded(algorithm: str, tmp_path: Path) -> None:
    """Both go on in the same episodes with the same draws, so that they become the same if both keep the copy."""
    own = BRIEF.model_copy(update={"episodes": 5, "epochs": 2, "keeping": 10.0})
    settings = learning(tmp_path, algorithm, own)
    kept = copied(tmp_path, settings)
    kept.learn(96)
    save_model(kept, tmp_path, replay_buffer=True)
    loaded = load_model(settings, tmp_path, 7, tmp_path)
    assert getattr(loaded, KEPT)[1] == 10.0
    assert np.array_equal(parameters_of(loaded), parameters_of(kept))
    kept._last_obs = None  # its episodes begin anew, as those of the one that was loaded do
    for model in (kept, loaded):
        model.set_random_seed(7)
        model.learn(96, reset_num_timesteps=False)
        environments_of(model).close()
    assert np.array_equal(parameters_of(loaded), parameters_of(kept))


@pytest.mark.sweep
@pytest.mark.parametrize("algorithm", REMEMBERING)
def test_a_run_begins_as_a_copy_and_is_resumed(algorithm: str, tmp_path: Path) -> None:
    own = BRIEF.model_copy(update={"episodes": 2, "epochs": 1})
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, learning(tmp_path, algorithm, own), seed=1, console=Console(quiet=True))
    assert folder.progress("best").timesteps == 0
    assert resume_training(folder, timesteps=128, console=Console(quiet=True)).timesteps == 128


def test_keeping_goes_with_a_memory(tmp_path: Path) -> None:
    asked = requested_training(EnvironmentOptions(), algorithm="sac", teacher="controller")
    assert asked.imitation == ImitationSettings()
    file = tmp_path / "kept.toml"
    file.write_text('based_on = "ppo"\n[imitation]\nkeeping = 1.0\n', encoding="utf-8")
    with pytest.raises(
        InvalidInputError, match=r"imitation\.keeping = 1\.0 goes with algorithms that learn from a memory"
    ):
        requested_training(EnvironmentOptions(), preset=str(file))


def test_values_of_nothing_leave_no_number_undefined(tmp_path: Path) -> None:
    """Where critics say nothing but 0, the copy is all that counts."""
    model = copied(tmp_path, learning(tmp_path, "td3", BRIEF.model_copy(update={"episodes": 2, "epochs": 1})))
    actor, critic = model.policy.actor, model.policy.critic
    with torch.no_grad():
        for parameter in critic.parameters():
            parameter.zero_()
    actor.optimizer.zero_grad()
    seen = model.replay_buffer.sample(16, env=model.get_vec_normalize_env()).observations
    critic(seen, acted(actor, seen)[0])[0].mean().backward()
    actor.optimizer.step()
    assert np.isfinite(parameters_of(model)).all()
    environments_of(model).close()
