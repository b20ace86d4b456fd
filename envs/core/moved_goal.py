"""The goal of an episode under way, put elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from dq_marine.backend.packing import pack
from dq_marine.envs.core.shared_memory import parameters_of, task_memory
from dq_marine.envs.core.start import GOAL_POSITION
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.envs.core.marine_env import MarineEnv

GOAL_QUATERNION = "goal_quaternion"
"""Option of tasks whose goal has an attitude that can be chosen."""


def move_goal(env: MarineEnv, position_ned: Sequence[float]) -> None:
    """Put the goal of an environment's episode elsewhere, in the attitude that it has; it is seen after the next step.

    Args:
        env: in an episode.
        position_ned: of the goal [m], shape (3,).

    Raises:
        InvalidInputError: the task has no goal that can be chosen, or it is up in the air; nothing is changed.
        ResetNeeded: before the first reset.
    """
    definition, numbers = env.definition, parameters_of(env)
    if GOAL_POSITION not in definition.options:
        raise InvalidInputError(
            f"the goal of {definition.id} stands where its episode puts it; only those of tasks with the option "
            f"{GOAL_POSITION!r} can be moved"
        )
    options: dict[str, Any] = {GOAL_POSITION: position_ned}
    goal = definition.goal(numbers.task, task_memory(env))
    if goal is not None and GOAL_QUATERNION in definition.options:
        options[GOAL_QUATERNION] = goal.attitude
    there = env.episode_parameters(env.checked_options(options)).task
    moved = {name: getattr(there, name) for name in definition.episode_fields}
    env.episode.episode_parameters = pack(numbers._replace(task=numbers.task._replace(**moved)))
