"""Keywords that hold while an environment is learned in, and no longer where the policy is judged or flies."""

from __future__ import annotations

import io
import itertools
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError
from rich.console import Console
from stable_baselines3.common.vec_env import VecNormalize
from support.trainings import tiny

from dq_marine.agents.policies import trained_environment
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.learners import make_evaluation_envs, make_training_envs
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.agents.training.training import begin_training
from dq_marine.errors import InvalidInputError


def learning(tmp_path: Path, **keywords: object) -> TrainingSettings:
    return tiny(tmp_path, "ppo", 64).model_copy(update={"while_learning": keywords})


def steps_of_an_episode(envs: VecNormalize) -> int:
    envs.seed(0)
    envs.reset()
    for step in itertools.count(1):
        _, _, over, _ = envs.step(np.zeros((envs.num_envs, 6), np.float32))
        if over.any():
            envs.close()
            return step
    return 0


def test_they_hold_for_learning_alone(tmp_path: Path) -> None:
    settings = learning(tmp_path, max_episode_steps=7)
    assert steps_of_an_episode(make_training_envs(settings)) == 7
    assert steps_of_an_episode(make_evaluation_envs(settings)) == 30
    run = RunFolder(tmp_path / "run")
    begin_training(run, settings, seed=1, console=Console(file=io.StringIO()))
    assert run.read_plan().settings == settings
    assert trained_environment(run.path) == settings.environment


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"sensors": "auv"}, r"while_learning = .*changes the observations.*leave them as they are"),
        ({"start_radios": 2.0}, "start_radios"),
    ],
)
def test_what_the_policy_could_not_fly_with_is_refused(
    keywords: dict[str, object], message: str, tmp_path: Path
) -> None:
    settings = learning(tmp_path, **keywords)
    with pytest.raises(InvalidInputError, match=message):
        begin_training(RunFolder(tmp_path / "run"), settings, console=Console(quiet=True))
    assert not (tmp_path / "run").exists()


def test_it_shows_no_policy_what_no_sensor_tells(tmp_path: Path) -> None:
    content = learning(tmp_path, privileged=["current"]).model_dump()
    with pytest.raises(
        ValidationError, match="keyword privileged would show the policy what no sensor tells"
    ):
        TrainingSettings.model_validate(content)
