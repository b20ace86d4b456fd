"""Terms that someone adds to the reward of a task, checked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from dq_marine.checks import finite_number, shown
from dq_marine.envs.core.definition import LARGEST_WEIGHT
from dq_marine.errors import InvalidInputError
from dq_marine.task.protocol import RewardTerm

if TYPE_CHECKING:
    from dq_marine.envs.core.definition import TaskDefinition


def checked_extra_rewards(terms: Sequence[RewardTerm], definition: TaskDefinition) -> tuple[RewardTerm, ...]:
    """Return the terms.

    Raises:
        InvalidInputError: they are no terms, a weight is not finite or too large, or a name is taken.
    """
    if isinstance(terms, RewardTerm) or not isinstance(terms, Sequence):
        raise InvalidInputError(f"extra_rewards = {shown(terms)}; give a list of dq_marine.RewardTerm")
    taken = list(definition.reward_names)
    for term in terms:
        if not isinstance(term, RewardTerm) or not callable(term.function):
            raise InvalidInputError(
                f"extra_rewards has {shown(term)}; give dq_marine.RewardTerm(name, function, weight)"
            )
        label = f"weight of the reward {term.name!r}"
        finite_number(label, term.weight, least=-LARGEST_WEIGHT, most=LARGEST_WEIGHT)
        if term.name in taken:
            raise InvalidInputError(f"there are two rewards {term.name!r}; give each a name of its own")
        taken.append(term.name)
    return tuple(terms)
