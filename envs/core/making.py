"""What `gym.make` calls: one environment, observed by numbers or by pictures."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from dq_marine.checks import shown
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.goal_env import GoalMarineEnv
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.pixels import PixelObservation, picture_size
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError


def make_single(
    task: TaskDefinition | str, *arguments: Any, observation: Any = "numbers", **keywords: Any
) -> gym.Env[Any, Any]:
    """Return an environment of a task.

    Args:
        task: the id of a registered task, or a definition.
        arguments: see `MarineEnv`.
        observation: "numbers", those of the task; "pixels", pictures in their place; or {"pixels": [width, height]}.
        keywords: see `MarineEnv`.

    Raises:
        InvalidInputError: a value is wrong, a keyword unknown, or pictures are to have a privileged part.
        VehicleFileError: the vehicle file is wrong.
        MissingDependencyError: pictures are asked for, and meshcat or a Chromium is not installed.
    """
    definition, size = task_named(task), picture_size(observation)
    env = (GoalMarineEnv if definition.has_goals else MarineEnv)(definition, *arguments, **keywords)
    if size is None:
        return env
    if env.privileged:
        raise InvalidInputError(
            f"privileged = {list(env.privileged)} and observation = {shown(observation)}: pictures have no such part; "
            "leave one of them out"
        )
    return PixelObservation(env, *size)


make_single.metadata = MarineEnv.metadata  # type: ignore[attr-defined]  # where `gym.make` looks for render modes
