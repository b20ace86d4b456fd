"""A policy that begins as the copy of a baseline: it does what that does, and its critic knows what that earns."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import torch
from rich.console import Console
from support.trainings import parameters_of, tiny

from dq_marine.agents.controllers.baselines import ZeroAgent, make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.settings import ImitationSettings, NetworkSettings, TrainingSettings
from dq_marine.agents.training import teaching
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.learners import environments_of, make_model
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.teaching import Pupil, taught
from dq_marine.agents.training.training import begin_training
from dq_marine.agents.tuning.tuning import plan_of
from dq_marine.cli.agent_options import EnvironmentOptions, requested_training
from dq_marine.errors import InvalidInputError

BRIEF = ImitationSettings(episodes=40, epochs=60, batch_size=64, learning_rate=3e-3)


def learning(tmp_path: Path, own: ImitationSettings = BRIEF) -> TrainingSettings:
    wide = NetworkSettings(layers=(32,), activation="tanh")
    return tiny(tmp_path, "ppo", 64).model_copy(update={"imitation": own, "network": wide})


def test_the_copy_does_what_the_teacher_does_and_values_what_that_earns(tmp_path: Path) -> None:
    settings = learning(tmp_path)
    model = make_model(settings, 3, tmp_path)
    error = imitate(model, settings, 3)
    lessons = taught(settings, BRIEF, np.random.default_rng(8))
    assert error < 0.3 * float(np.mean(np.square(lessons.actions)))
    envs = model.get_vec_normalize_env()
    observations, _ = model.policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    with torch.no_grad():
        actions = model.policy.get_distribution(observations).distribution.mean.numpy()
        values = model.policy.predict_values(observations).numpy().ravel()
    assert np.mean(np.square(actions - lessons.actions)) < 0.3 * np.mean(np.square(lessons.actions))
    assert values.std() > 0.0
    environments_of(model).close()


@pytest.mark.sweep
def test_it_follows_from_the_seed(tmp_path: Path) -> None:
    settings = learning(tmp_path, BRIEF.model_copy(update={"episodes": 1, "epochs": 2}))
    made = {}
    for name, seed in (("one", 3), ("again", 3), ("other", 4)):
        model = make_model(settings, seed, tmp_path)
        imitate(model, settings, seed)
        made[name] = parameters_of(model)
        environments_of(model).close()
    assert np.array_equal(made["one"], made["again"])
    assert not np.array_equal(made["one"], made["other"])


@pytest.mark.parametrize("algorithm", ["ppo", "recurrent_ppo"])
def test_the_rate_falls_from_epoch_to_epoch_to_the_one_that_is_asked_for(
    tmp_path: Path, algorithm: str
) -> None:
    """A second epoch at next to no rate changes nothing; one at the same rate does."""
    one = ImitationSettings(episodes=1, epochs=1, batch_size=64, learning_rate=1e-2)
    made = {}
    for name, own in {
        "one": one,
        "falling": one.model_copy(update={"epochs": 2, "final_learning_rate": 1e-9}),
        "same": one.model_copy(update={"epochs": 2, "final_learning_rate": 1e-2}),
    }.items():
        settings = tiny(tmp_path, algorithm, 64).model_copy(update={"imitation": own})
        model = make_model(settings, 3, tmp_path)
        imitate(model, settings, 3)
        made[name] = parameters_of(model)
        environments_of(model).close()
    np.testing.assert_allclose(made["falling"], made["one"], rtol=0.0, atol=1e-6)
    assert np.abs(made["same"] - made["one"]).max() > 1e-3


@pytest.mark.parametrize("whole", [True, False])
def test_returns_are_discounted_sums_of_what_follows(whole: bool) -> None:
    rewards, gamma = np.random.default_rng(0).normal(size=40).tolist(), 0.8
    returns = teaching._returns(rewards, gamma, whole=whole)
    expected = [sum(gamma**k * reward for k, reward in enumerate(rewards[i:])) for i in range(40)]
    known = 40 if whole else 25  # 3/(1 - 0.8) periods before the end are not known
    assert returns[:known] == pytest.approx(expected[:known], abs=1e-12)
    assert np.isnan(returns[known:]).all()


def test_where_the_pupil_flies_it_is_told_what_the_teacher_would_do(tmp_path: Path) -> None:
    settings = learning(tmp_path)
    own = BRIEF.model_copy(update={"episodes": 2, "noise": 0.0})
    lessons = taught(settings, own, np.random.default_rng(0), pupil=ZeroAgent(6), first=70)
    env = make_environment(settings.environment)
    teacher = make_baseline("controller", env, 0)
    row = 0
    for seed in (70, 71):
        observation, _ = env.reset(seed=seed)
        teacher.reset(env)
        over = False
        while not over:
            np.testing.assert_array_equal(lessons.observations[row], observation)
            np.testing.assert_array_equal(lessons.actions[row], np.clip(teacher.act(observation), -1.0, 1.0))
            observation, _, terminated, truncated, _ = env.step(np.zeros(6, np.float32))
            over, row = terminated or truncated, row + 1
    assert row == len(lessons.actions)


@pytest.mark.sweep
def test_further_rounds_make_the_copy_alike_where_it_flies_itself(tmp_path: Path) -> None:
    missed = {}
    for rounds in (0, 3):
        own = BRIEF.model_copy(update={"episodes": 8, "epochs": 30, "rounds": rounds})
        settings = learning(tmp_path, own)
        model = make_model(settings, 3, tmp_path)
        imitate(model, settings, 3)
        pupil = Pupil(model.policy, model.get_vec_normalize_env())
        flown = own.model_copy(update={"episodes": 20, "noise": 0.0})
        lessons = taught(settings, flown, np.random.default_rng(0), pupil=pupil, first=10_000)
        acted = np.array([pupil.act(one) for one in lessons.observations])
        missed[rounds] = float(np.mean(np.square(acted - lessons.actions)))
        environments_of(model).close()
    assert missed[3] < 0.7 * missed[0]


@pytest.mark.parametrize(("rounds", "moves"), [(0, True), (1, False)])
def test_after_further_rounds_the_policy_goes_on_reading_numbers_as_it_learned_to(
    rounds: int, moves: bool, tmp_path: Path
) -> None:
    settings = learning(tmp_path, BRIEF.model_copy(update={"episodes": 1, "epochs": 1, "rounds": rounds}))
    model = make_model(settings, 3, tmp_path)
    imitate(model, settings, 3)
    envs = model.get_vec_normalize_env()
    far = np.full((1, *model.observation_space.shape), 3.0)
    before = envs.normalize_obs(far)
    model.learn(64)
    assert (np.abs(envs.normalize_obs(far) - before).max() > 1e-6) == moves
    environments_of(model).close()


@pytest.mark.sweep
def test_a_run_says_how_like_the_teacher_it_begins(tmp_path: Path) -> None:
    console = Console(file=io.StringIO(), width=200)
    settings = learning(tmp_path, BRIEF.model_copy(update={"episodes": 1, "epochs": 1}))
    begin_training(RunFolder(tmp_path / "run"), settings, seed=1, console=console)
    assert "Begins as a copy of the controller: its actions differ by 0." in console.file.getvalue()  # type: ignore[attr-defined]
    assert RunFolder(tmp_path / "run").read_plan().settings == settings


def test_what_cannot_teach_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"imitation\.teacher"):
        requested_training(EnvironmentOptions(), teacher="zero")
    asked = requested_training(EnvironmentOptions(), teacher="controller").imitation
    assert asked == ImitationSettings()
    settings = learning(tmp_path, BRIEF.model_copy(update={"teacher": "lqr"}))
    model = make_model(settings, 0, tmp_path)
    before = parameters_of(model)
    with pytest.raises(InvalidInputError):
        imitate(model, settings, 0)
    assert np.array_equal(parameters_of(model), before)
    environments_of(model).close()


def test_a_teacher_that_cannot_fly_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    settings = learning(tmp_path, BRIEF.model_copy(update={"teacher": "lqr"}))
    with pytest.raises(InvalidInputError, match=r"the controller reads .*give it an environment"):
        begin_training(RunFolder(tmp_path / "run"), settings, console=Console(quiet=True))
    assert not (tmp_path / "run").exists()
    with pytest.raises(InvalidInputError, match=r"the controller reads .*give it an environment"):
        plan_of(settings, seed=0)


def test_the_copy_is_the_best_until_what_it_becomes_is_better(tmp_path: Path) -> None:
    """Learning may make it worse, and a run too short to be evaluated has learned next to nothing."""
    folder = RunFolder(tmp_path / "run")
    settings = learning(tmp_path, BRIEF.model_copy(update={"episodes": 1, "epochs": 1}))
    begin_training(folder, settings, seed=1, console=Console(quiet=True))
    assert settings.timesteps < settings.evaluation.every
    best = folder.progress("best")
    assert best.timesteps == 0
    assert best.mean_return is not None
    assert folder.progress("checkpoints").timesteps >= settings.timesteps
