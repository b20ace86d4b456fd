"""A task's preset with another algorithm: what is learned stays the task's, how it is learned is the algorithm's."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.trainings import ALGORITHMS

from dq_marine.agents.algorithm_settings import ReplaySettings
from dq_marine.agents.other_algorithm import COPY, with_algorithm
from dq_marine.agents.preset_files import preset_names, read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.cli.agent_options import EnvironmentOptions, requested_training
from dq_marine.errors import InvalidInputError

TASKS = [name for name in preset_names() if name[0].isupper()]


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_every_task_can_be_learned_by_every_algorithm(task: str, algorithm: str) -> None:
    asked, own = read_settings(task, TrainingSettings), read_settings(algorithm, TrainingSettings)
    made = with_algorithm(asked, algorithm)
    assert (made.environment, made.learned_in, made.evaluated_in) == (
        asked.environment,
        asked.learned_in,
        asked.evaluated_in,
    )
    assert made.algorithm.name == algorithm
    assert made.algorithm.gamma == asked.algorithm.gamma
    assert made.network.layers == own.network.layers
    assert made.normalisation.symlog == asked.normalisation.symlog
    assert (made.timesteps, made.envs) == (own.timesteps, own.envs)
    from_memory = isinstance(made.algorithm, ReplaySettings)
    assert made.imitation == (asked.imitation or (COPY if from_memory else None))
    if from_memory:  # small steps, often evaluated: what was copied is to be kept
        assert made.evaluation.every < own.evaluation.every
        assert made.algorithm.final_learning_rate < made.algorithm.learning_rate < own.algorithm.learning_rate
    left = {"gamma", *(("learning_rate", "learning_starts") if from_memory else ("log_std_init",))}
    assert made.algorithm.model_dump(exclude=left) == own.algorithm.model_dump(exclude=left)


@pytest.mark.parametrize("there", ["ppo", "recurrent_ppo", "td3"])
def test_there_and_back_is_the_same_task(there: str) -> None:
    """From an algorithm with a memory, too, whose settings say how a copy is kept, which PPO's cannot."""
    first = with_algorithm(read_settings("Docking", TrainingSettings), "sac")
    kept = first.imitation.model_copy(update={"keeping": 2.0})
    asked = first.model_copy(update={"imitation": kept})
    back = with_algorithm(with_algorithm(asked, there), "sac")
    expected = kept if there == "td3" else first.imitation
    assert back == first.model_copy(update={"imitation": expected})


def test_the_options_of_the_environment_come_last() -> None:
    made = requested_training(
        EnvironmentOptions(vehicle="rexrov"), preset="WaypointTracking", algorithm="sac"
    )
    asked = read_settings("WaypointTracking", TrainingSettings)
    assert made.environment.id == asked.environment.id
    assert made.environment.keywords == {**asked.environment.keywords, "vehicle": "rexrov"}
    assert made.algorithm.name == "sac"


def test_its_own_algorithm_changes_nothing() -> None:
    asked = read_settings("Docking", TrainingSettings)
    assert requested_training(EnvironmentOptions(), preset="Docking", algorithm="ppo") == asked


def test_what_the_algorithm_cannot_do_is_refused(tmp_path: Path) -> None:
    critic = read_settings("Docking", TrainingSettings).model_copy(update={"privileged_critic": ("current",)})
    with pytest.raises(InvalidInputError, match=r"with crossq is refused:\n.*takes no observations in parts"):
        with_algorithm(critic, "crossq")
    with pytest.raises(
        InvalidInputError, match=r"--algorithm ppo does not go with --preset sac, which is another"
    ):
        requested_training(EnvironmentOptions(), preset="sac", algorithm="ppo")
