"""Goals that an observation shows, and the reward of a step had another been asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_rows
from dq_marine.envs.core.definition import PARTS, Observed, TaskDefinition
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.envs.core.composed_task import ComposedTask

GOAL_TERM = "goal"
"""The reward's term that `goal_reward` gives."""


def check_goals(definition: TaskDefinition, observations: Sequence[Observed]) -> None:
    """Check that a task has all that belongs to goals, or nothing of it.

    Raises:
        InvalidInputError: it lacks something, or a part is unknown.
    """
    sizes = {part: sum(one.size for one in observations if one.part == part) for part in PARTS}
    strange = sorted({one.part for one in observations} - set(PARTS))
    if strange:
        raise InvalidInputError(f"{definition.id} observes in parts {strange}; there are {list(PARTS)}")
    achieved, desired = (sizes[part] for part in PARTS[1:])
    if definition.goal_reward is None:
        if achieved or desired:
            raise InvalidInputError(f"{definition.id} observes goals, but has no goal_reward; define it")
        return
    if not sizes[PARTS[0]] or not achieved or achieved != desired:
        raise InvalidInputError(
            f"{definition.id} has a goal_reward, and observes {sizes}; give each part some numbers, and both goals "
            "as many"
        )
    if GOAL_TERM not in definition.reward_names:
        raise InvalidInputError(
            f"{definition.id} has a goal_reward, but {list(definition.reward_names)} for terms of the reward; name "
            f"the one that it gives {GOAL_TERM!r}"
        )


def goal_rewards(
    env: ComposedTask,
    achieved_goal: NDArray[Any],
    desired_goal: NDArray[Any],
    info: Mapping[str, Any] | Sequence[Mapping[str, Any]],
) -> Any:
    """Return rewards at other goals; see `MarineEnv.compute_reward`."""
    formula, places = env.definition.goal_reward, env.observation_places
    if formula is None or places is None:
        raise InvalidInputError(f"{env.definition.id} has no goals, so no rewards at other goals")
    size = len(places["desired_goal"])
    infos = [info] if isinstance(info, Mapping) else info
    achieved, desired = (
        finite_rows(name, given, len(infos), size)
        for name, given in (("achieved_goal", achieved_goal), ("desired_goal", desired_goal))
    )
    parameters = env.episode_parameters({})
    rewards = np.array(
        [
            formula(parameters.task, parameters.weights, tuple(here), tuple(there)) + _other_terms(env, one)
            for here, there, one in zip(achieved.tolist(), desired.tolist(), infos, strict=True)
        ]
    )
    return float(rewards[0]) if np.ndim(desired_goal) == 1 and isinstance(info, Mapping) else rewards


def _other_terms(env: ComposedTask, info: Mapping[str, Any]) -> float:
    names = [f"reward/{name}" for name in env.reward_names if name != GOAL_TERM]
    missing = [name for name in names if name not in info]
    if missing:
        raise InvalidInputError(
            f"info lacks {missing}; give the step's own, with HerReplayBuffer(copy_info_dict=True)"
        )
    return sum(float(info[name]) for name in names)
