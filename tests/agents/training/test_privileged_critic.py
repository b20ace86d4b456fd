"""A critic that sees what only the simulator knows, and an actor that does not: not while it learns, nor in flight."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from rich.console import Console
from sb3_contrib.common.recurrent.type_aliases import RNNStates
from support.sweeps import sweep
from support.trainings import ALGORITHMS, parameters_of, tiny

from dq_marine.agents.deployment.export import export_policy
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.environments import make_environment, with_keywords
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.preset_files import validate_settings
from dq_marine.agents.settings import CurriculumSettings, ImitationSettings, TrainingSettings
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.learners import environments_of, load_model, make_model, save_model
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training, resume_training
from dq_marine.agents.tuning.tuning import plan_of
from dq_marine.cli.agent_options import EnvironmentOptions, requested_training
from dq_marine.envs.core.definition import PRIVILEGED
from dq_marine.errors import InvalidInputError

ABLE = [name for name in ALGORITHMS if name != "crossq"]
BOTH = ("current", "vehicle")
ROUND_OFF = 1e-6
"""Of actions in [-1, 1] from single precision."""


def hiding(settings: TrainingSettings, **keywords: Any) -> TrainingSettings:
    """Return settings with a privileged critic, in an environment whose current and vehicle nobody tells of."""
    environment = with_keywords(
        settings.environment, current=0.5, randomise="default", vehicle_pool=4, **keywords
    )
    return settings.model_copy(update={"environment": environment, "privileged_critic": BOTH})


@pytest.fixture
def console() -> Console:
    return Console(file=io.StringIO(), width=200)


def decided(model: Any, seen: dict[str, np.ndarray]) -> np.ndarray:
    """Return what the actor does."""
    return model.predict(seen, deterministic=True)[0]


def valued(model: Any, seen: dict[str, np.ndarray]) -> np.ndarray:
    """Return what the critic says of observations, and of one action where it is asked for actions, too."""
    policy = model.policy
    tensors, _ = policy.obs_to_tensor(seen)
    count = len(seen["observation"])
    with torch.no_grad():
        if hasattr(policy, "lstm_critic"):
            zeros = torch.zeros(1, count, policy.lstm_critic.hidden_size)
            states = RNNStates((zeros, zeros), (zeros, zeros))
            return policy.predict_values(tensors, states.vf, torch.ones(count)).numpy().ravel()
        if hasattr(policy, "predict_values"):
            return policy.predict_values(tensors).numpy().ravel()
        told = policy.critic(tensors, torch.full((count, 6), 0.1))
        return (told[0] if isinstance(told, tuple) else told).numpy().reshape(count, -1)[:, 0]


@pytest.mark.parametrize("algorithm", sweep(ABLE, plain=["ppo", "sac", "recurrent_ppo", "tqc"]))
def test_the_critic_sees_it_and_the_actor_does_not(tmp_path: Path, algorithm: str) -> None:
    model = make_model(hiding(tiny(tmp_path, algorithm, 96)), 3, tmp_path)
    for learned in (False, True):
        if learned:
            model.learn(96)
        seen = model.get_env().reset()
        otherwise = seen | {PRIVILEGED: np.flip(seen[PRIVILEGED], axis=1) + np.float32(1.0)}
        unknown = seen | {PRIVILEGED: np.full_like(seen[PRIVILEGED], np.nan)}
        actions = decided(model, seen)
        assert np.array_equal(decided(model, otherwise), actions)
        assert np.array_equal(decided(model, unknown), actions)
        assert np.array_equal(decided(model, {"observation": seen["observation"]}), actions)
        assert (valued(model, otherwise) != valued(model, seen)).all()
    environments_of(model).close()


def test_the_actors_net_is_the_one_of_an_ordinary_training(tmp_path: Path) -> None:
    settings = hiding(tiny(tmp_path, "ppo"))
    ordinary = make_model(settings.model_copy(update={"privileged_critic": ()}), 3, tmp_path)
    privileged = make_model(settings, 3, tmp_path)
    actors = [
        [one.shape for one in model.policy.mlp_extractor.policy_net.parameters()]
        for model in (ordinary, privileged)
    ]
    assert actors[0] == actors[1]
    for model in (ordinary, privileged):
        environments_of(model).close()


@pytest.mark.parametrize("algorithm", sweep(ABLE, plain=["ppo", "sac"]))
def test_what_was_learned_flies_and_is_exported_without_it(
    tmp_path: Path, algorithm: str, console: Console
) -> None:
    settings, folder = hiding(tiny(tmp_path, algorithm, 128)), RunFolder(tmp_path / "run")
    begin_training(folder, settings, seed=1, console=console)
    assert folder.read_plan().settings == settings
    own, env = TrainedPolicy(folder), make_environment(settings.environment)
    with_it = make_environment(settings.learned_in)
    public, both = env.reset(seed=4)[0], with_it.reset(seed=4)[0]
    own.reset(env)
    action = own.act(public)
    own.reset(with_it)
    assert np.array_equal(own.act(both), action)
    (score,) = evaluate(env, {"policy": own}, episodes=1, seed=4)
    assert (score,) == tuple(evaluate(with_it, {"policy": own}, episodes=1, seed=4))
    if algorithm == "recurrent_ppo":
        return
    exported = export_policy(folder, [tmp_path / "out" / "policy.onnx"], episodes=1)
    flown = OnnxPolicy(exported.files[0])
    flown.reset(env)
    assert flown.description.inputs == {"observation": public.size}
    assert flown.description.environment == settings.environment
    observations = np.random.default_rng(0).normal(size=(50, public.size)).astype(np.float32)
    for one in observations:
        np.testing.assert_allclose(flown.act(one), own.act(one), rtol=0.0, atol=ROUND_OFF)
    assert 'privileged_critic = ["current", "vehicle"]' in exported.files[-1].read_text(encoding="utf-8")


@pytest.mark.parametrize("algorithm", sweep(ABLE, plain=["ppo"]))
def test_a_model_that_was_saved_goes_on_as_the_one_that_was_not(tmp_path: Path, algorithm: str) -> None:
    settings = hiding(tiny(tmp_path, algorithm, 192))
    kept = make_model(settings, 3, tmp_path)
    kept.learn(96)
    save_model(kept, tmp_path, replay_buffer=True)
    loaded = load_model(settings, tmp_path, 7, tmp_path)
    assert np.array_equal(parameters_of(loaded), parameters_of(kept))
    for name, running in kept.get_vec_normalize_env().obs_rms.items():
        assert np.array_equal(loaded.get_vec_normalize_env().obs_rms[name].mean, running.mean), name
    kept._last_obs = None  # its episodes begin anew, as those of the one that was loaded do
    for model in (kept, loaded):
        model.set_random_seed(7)  # of generators that both share, too
        model.learn(96, reset_num_timesteps=False)
        environments_of(model).close()
    assert np.array_equal(parameters_of(loaded), parameters_of(kept))


def test_a_run_is_resumed_with_its_critic(tmp_path: Path, console: Console) -> None:
    folder = RunFolder(tmp_path / "run")
    begin_training(folder, hiding(tiny(tmp_path, "ppo", 64)), console=console)
    assert resume_training(folder, timesteps=128, console=console).timesteps == 128
    assert folder.read_plan().settings.privileged_critic == BOTH
    assert PRIVILEGED in TrainedPolicy(folder).model.observation_space.spaces


@pytest.mark.parametrize("algorithm", sweep(ABLE, plain=["ppo", "sac", "recurrent_ppo"]))
def test_a_copy_of_a_teacher_is_made_without_it_and_its_critic_with_it(
    algorithm: str, tmp_path: Path
) -> None:
    brief = ImitationSettings(episodes=6, epochs=10, batch_size=64, learning_rate=3e-3)
    settings = hiding(tiny(tmp_path, algorithm, 64)).model_copy(update={"imitation": brief})
    model = make_model(settings, 3, tmp_path)
    before = parameters_of(model)
    error = imitate(model, settings, 3)
    assert 0.0 < error < 1.0
    assert (parameters_of(model) != before).any()
    assert model.get_vec_normalize_env().obs_rms[PRIVILEGED].count > 100.0  # of what the teacher flew
    seen = model.get_env().reset()
    other = seen | {PRIVILEGED: seen[PRIVILEGED] + np.float32(1.0)}
    assert np.array_equal(decided(model, other), decided(model, seen))
    assert (valued(model, other) != valued(model, seen)).all()
    ordinary = settings.model_copy(update={"privileged_critic": ()})
    same = make_model(ordinary, 3, tmp_path)
    assert imitate(same, ordinary, 3) == pytest.approx(error, abs=0.2)
    for one in (model, same):
        environments_of(one).close()


def test_it_can_be_asked_for(tmp_path: Path) -> None:
    assert not requested_training(EnvironmentOptions()).privileged_critic
    asked = requested_training(EnvironmentOptions(), privileged_critic=["truth", "current"])
    assert asked.privileged_critic == ("truth", "current")
    with pytest.raises(
        InvalidInputError, match=r"privileged_critic\.0 = 'thrust'.*'current', 'vehicle' or 'truth'"
    ):
        requested_training(EnvironmentOptions(), privileged_critic=["thrust"])
    preset = tmp_path / "own.toml"
    preset.write_text('based_on = "ppo"\nprivileged_critic = ["current"]\n', encoding="utf-8")
    asked = requested_training(EnvironmentOptions(), preset=str(preset))
    assert asked.privileged_critic == ("current",)
    assert "privileged" not in asked.environment.keywords
    assert asked.learned_in.keywords == {**asked.environment.keywords, "privileged": ["current"]}


def test_what_cannot_be_done_is_refused_before_anything_is_written(tmp_path: Path, console: Console) -> None:
    with pytest.raises(InvalidInputError, match=r"algorithm\.name = 'crossq'.* train with ppo"):
        requested_training(EnvironmentOptions(), algorithm="crossq", privileged_critic=["current"])
    settings = tiny(tmp_path, "ppo", 64)
    content = settings.model_dump()
    content["environment"]["keywords"]["privileged"] = "current"
    with pytest.raises(
        InvalidInputError, match=r"show the policy what no sensor tells; set privileged_critic"
    ):
        validate_settings(content, TrainingSettings, source="a preset")
    still = settings.model_copy(
        update={
            "environment": with_keywords(settings.environment, current=0.0),
            "privileged_critic": ("current",),
        }
    )
    with pytest.raises(
        InvalidInputError, match=r"hides none of it from the agent; give a current, or leave 'current' out"
    ):
        begin_training(RunFolder(tmp_path / "run"), still, console=console)
    assert not (tmp_path / "run").exists()
    with pytest.raises(InvalidInputError, match="hides none of it from the agent"):
        plan_of(still, seed=0)


def test_lessons_in_still_water_go_with_it(tmp_path: Path, console: Console) -> None:
    """What the critic sees must be alike at all levels: a current of zero stands where the water is still."""
    settings = tiny(tmp_path, "ppo", 64)
    environment = with_keywords(settings.environment, level="medium")
    curriculum = CurriculumSettings(levels=("easy",), success=0.0, episodes=1)
    lessons = settings.model_copy(
        update={"environment": environment, "curriculum": curriculum, "privileged_critic": ("current",)}
    )
    begin_training(RunFolder(tmp_path / "run"), lessons, console=console)
    assert "Level easy is learned" in console.file.getvalue()  # type: ignore[attr-defined]
