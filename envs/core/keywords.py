"""Which keywords an environment takes that a file can say."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import fields

from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.errors import InvalidInputError
from dq_marine.simulation.settings import Settings

OTHERS = ("level", "perturb", "reward", "max_episode_steps")
"""Keywords of every environment that are neither those of `Settings` nor the task's own."""

NOT_WRITTEN = ("forces",)
"""Keywords of `Settings` that only Python can give."""


def writable_keywords(definition: TaskDefinition) -> tuple[str, ...]:
    """Return the keywords that a file may give to a task's environment, sorted."""
    of_all = {one.name for one in fields(Settings)} | set(OTHERS)
    return tuple(sorted((of_all | set(definition.keywords)) - set(NOT_WRITTEN)))


def check_known(identifier: str, names: Iterable[str], known: tuple[str, ...]) -> None:
    """Check that an environment takes keywords.

    Args:
        identifier: of the environment, for the message.
        names: of the keywords.
        known: those that it takes.

    Raises:
        InvalidInputError: it does not know one; the message says which it may have been, and lists all.
    """
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            meant = f" (did you mean {near[0]}?)" if near else ""
            raise InvalidInputError(
                f"{identifier} has no keyword {name!r}{meant}; it takes {', '.join(known)}"
            )
