"""Algorithms: of which library, what their policies remember, and what they refuse."""

from __future__ import annotations

import io
import pickle
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from support.trainings import ALGORITHMS, tiny

from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.agents.preset_files import read_settings, validate_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.algorithms import (
    OF_CONTRIB,
    OWN,
    LinearSchedule,
    keywords_of,
    model_class,
    policy_name,
)
from dq_marine.agents.training.learners import environments_of, make_model
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training
from dq_marine.cli.options import Algorithm
from dq_marine.errors import InvalidInputError, MissingDependencyError


def test_each_has_a_class_a_preset_and_a_name_on_the_command_line() -> None:
    assert set(OWN) | set(OF_CONTRIB) == set(ALGORITHMS) == {one.value for one in Algorithm}
    for name in ALGORITHMS:
        settings = read_settings(name, TrainingSettings)
        assert settings.algorithm.name == name
        assert model_class(name).__name__.lower() == name.replace("_", "")


@pytest.mark.parametrize("name", ALGORITHMS)
def test_a_model_is_what_its_settings_say(name: str, tmp_path: Path) -> None:
    settings = tiny(tmp_path, name)
    algorithm = settings.algorithm
    model = make_model(settings, 3, tmp_path / "logs")
    for field, wanted in algorithm.model_dump(exclude={"name", *algorithm.OF_THE_POLICY}).items():
        if field == "clip_range":
            assert model.clip_range(1.0) == wanted
        elif field == "train_freq":
            assert model.train_freq.frequency == wanted
        elif field == "minibatches":
            assert model.batch_size * wanted == settings.envs * algorithm.n_steps
        elif field == "exploration_noise":
            np.testing.assert_array_equal(model.action_noise._sigma, np.full(6, wanted))
        elif field not in ("learning_rate", "final_learning_rate"):
            assert getattr(model, field) == wanted, field
    rate = model.learning_rate
    assert (rate(1.0), rate(0.0)) == (algorithm.learning_rate, algorithm.final_learning_rate)
    for field in algorithm.OF_THE_POLICY:
        assert model.policy_kwargs[field] == getattr(algorithm, field)
    assert set(keywords_of(settings, environments_of(model).single)["policy_kwargs"]) == {
        *algorithm.OF_THE_POLICY,
        "net_arch",
        "activation_fn",
    }


@given(st.floats(-5000.0, 1.0))
def test_the_learning_rate_falls_to_its_last_and_not_below(progress: float) -> None:
    """SB3 collects whole rollouts: one of 4,096 steps in a training of 1 leaves a progress of -4,095."""
    rate = LinearSchedule(1e-3, 5e-5)(progress)
    assert 5e-5 <= rate <= 1e-3 * (1.0 + 1e-12)
    if progress > 0.0:
        assert rate == pytest.approx(5e-5 + 9.5e-4 * progress)


def test_schedules_of_runs_of_before_are_found_where_they_were() -> None:
    """Models hold them by the name of the module that they were in; not found, a run goes on at another rate."""
    schedule = pickle.loads(b"cdq_marine.agents.training.learners\nLinearSchedule\n(F0.5\nF0.25\ntR.")
    assert schedule == LinearSchedule(0.5, 0.25)
    assert schedule(0.0) == 0.25


def test_a_policy_with_a_memory_remembers_an_episode_and_forgets_it_at_the_next(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "run")
    settings = tiny(tmp_path, "recurrent_ppo", 64)
    begin_training(folder, settings, console=Console(file=io.StringIO()))
    policy, env = TrainedPolicy(folder), make_environment(settings.environment)
    observation, _ = env.reset(seed=0)
    policy.reset(env)
    first, second = policy.act(observation), policy.act(observation)
    assert (first != second).any(), "the same observation, seen again, is another situation"
    policy.reset(env)
    np.testing.assert_array_equal(policy.act(observation), first)
    flights = [fly_episode(env, policy, seed=4).actions for _ in range(2)]
    np.testing.assert_array_equal(*flights)


@pytest.mark.parametrize("name", OF_CONTRIB)
def test_without_its_library_the_message_names_the_extra(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sb3_contrib", None)
    with pytest.raises(
        MissingDependencyError, match=rf"training by {name} .*sb3_contrib.*dq-marine\[agents\]"
    ):
        model_class(name)


@pytest.mark.parametrize("name", ALGORITHMS)
def test_there_is_a_policy_for_goals_or_a_refusal(name: str, tmp_path: Path) -> None:
    algorithm = tiny(tmp_path, name).algorithm
    assert policy_name(algorithm, goals=False) in model_class(name).policy_aliases
    if name == "crossq":
        with pytest.raises(
            InvalidInputError, match="crossq takes no observations with goals; train with another"
        ):
            policy_name(algorithm, goals=True)
    else:
        assert policy_name(algorithm, goals=True) in model_class(name).policy_aliases


def test_quantiles_that_are_all_dropped_are_refused(tmp_path: Path) -> None:
    content = tiny(tmp_path, "tqc").model_dump()
    content["algorithm"]["top_quantiles_to_drop_per_net"] = 5
    message = r"algorithm\.tqc: top_quantiles_to_drop_per_net = 5 leaves none of n_quantiles = 5; drop fewer$"
    with pytest.raises(InvalidInputError, match=message):
        validate_settings(content, TrainingSettings, source="a preset")
