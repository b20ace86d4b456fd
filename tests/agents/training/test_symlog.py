"""Observations by the logarithm of their size: what it is, and that statistics, runs and their copies know it."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from pydantic import ValidationError
from rich.console import Console
from stable_baselines3.common.vec_env import DummyVecEnv
from support.trainings import tiny

from dq_marine.agents.deployment.export import export_policy
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.environments import make_environment
from dq_marine.agents.settings import NormalisationSettings
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.symlog import SymlogNormalize, symexp, symlog
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.agents.training.training import begin_training

numbers = arrays(np.float64, 5, elements=st.floats(-1e9, 1e9))


@given(numbers)
def test_it_is_odd_grows_and_is_undone(x: np.ndarray) -> None:
    np.testing.assert_allclose(symexp(symlog(x)), x, rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(symlog(-x), -symlog(x))
    assert (np.diff(symlog(np.sort(x))) >= 0.0).all()
    assert np.abs(symlog(x)).max() <= np.abs(x).max()


def test_a_metre_near_by_is_as_much_as_a_tenth_of_far_away() -> None:
    assert symlog(np.array([1.0])) == pytest.approx(np.log(2.0))
    assert symlog(np.array([1100.0])) - symlog(np.array([1000.0])) == pytest.approx(np.log(1.1), rel=1e-3)


class Wide(gym.Env[Any, Any]):
    """Observations from a millimetre to kilometres."""

    action_space = gym.spaces.Box(-1.0, 1.0, (1,), np.float32)

    def __init__(self, goals: bool) -> None:
        box = gym.spaces.Box(-1e6, 1e6, (3,), np.float32)
        self.observation_space = gym.spaces.Dict({"observation": box, "desired_goal": box}) if goals else box

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        return self._drawn(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        return self._drawn(), 0.0, False, bool(self.np_random.random() < 0.1), {}

    def _drawn(self) -> Any:
        def one() -> Any:
            return (self.np_random.normal(size=3) * 10.0 ** self.np_random.uniform(-3.0, 4.0, 3)).astype(
                np.float32
            )

        return (
            one()
            if isinstance(self.observation_space, gym.spaces.Box)
            else {"observation": one(), "desired_goal": one()}
        )


@pytest.mark.parametrize("goals", [False, True])
def test_means_and_deviations_are_those_of_the_logarithms(goals: bool) -> None:
    envs = SymlogNormalize(DummyVecEnv([lambda: Wide(goals)] * 2), clip_obs=20.0)
    envs.seed(3)
    envs.reset()
    seen = [envs.get_original_obs()]
    for _ in range(300):
        normalised, *_ = envs.step(np.zeros((2, 1)))
        seen.append(envs.get_original_obs())
    parts = {"observation": envs.obs_rms} if not goals else envs.obs_rms
    for name, running in parts.items():
        rows = np.concatenate([one[name] if goals else one for one in seen])
        told = np.sign(rows) * np.log(1.0 + np.abs(rows.astype(np.float64)))
        np.testing.assert_allclose(running.mean, told.mean(axis=0), atol=1e-3)
        np.testing.assert_allclose(running.var, told.var(axis=0), rtol=1e-2)
        last = normalised[name] if goals else normalised
        np.testing.assert_allclose(
            last, (told[-2:] - running.mean) / np.sqrt(running.var + 1e-8), rtol=1e-4, atol=1e-4
        )
    np.testing.assert_allclose(
        *(
            envs.unnormalize_obs(normalised)[one] if goals else envs.unnormalize_obs(normalised)
            for one in ["observation"]
        ),
        seen[-1]["observation"] if goals else seen[-1],
        rtol=1e-4,
        atol=1e-6,
    )


def test_a_run_is_loaded_and_exported_with_it(tmp_path: Path) -> None:
    settings = tiny(tmp_path, "ppo", 64)
    settings = settings.model_copy(
        update={"normalisation": settings.normalisation.model_copy(update={"symlog": True})}
    )
    run = RunFolder(tmp_path / "run")
    begin_training(run, settings, seed=1, console=Console(file=io.StringIO()))
    own = TrainedPolicy(run)
    assert isinstance(own.normalisation, SymlogNormalize)
    export_policy(run, [tmp_path / "out" / "policy.onnx"], episodes=1)
    exported = OnnxPolicy(tmp_path / "out" / "policy.onnx")
    env = make_environment(settings.environment)
    observation, _ = env.reset(seed=0)
    for scale in (0.01, 1.0, 100.0):
        seen = np.float32(scale) * observation
        np.testing.assert_allclose(exported.act(seen), own.act(seen), rtol=0.0, atol=1e-6)


def test_it_needs_observations_that_are_normalised(tmp_path: Path) -> None:
    own = tiny(tmp_path, "ppo", 64).normalisation.model_dump()
    with pytest.raises(ValidationError, match=r"symlog goes before .* set it true, or leave symlog out"):
        NormalisationSettings.model_validate(own | {"observation": False, "symlog": True})
