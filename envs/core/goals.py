"""What belongs to goals in the definition of a task, checked."""

from __future__ import annotations

from collections.abc import Sequence

from dq_marine.envs.core.definition import PARTS, Observed, TaskDefinition
from dq_marine.errors import InvalidInputError

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
    if not definition.has_goals:
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
