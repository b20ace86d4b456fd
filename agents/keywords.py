"""Which keywords an environment takes, and settings with other ones."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

import gymnasium as gym

from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.keywords import check_known, writable_keywords
from dq_marine.envs.core.registry import full_id, registered_tasks, task_named
from dq_marine.errors import InvalidInputError


def known_keywords(identifier: str) -> tuple[str, ...]:
    """Return the keywords that the settings of an environment may have, sorted.

    Args:
        identifier: as for `gym.make`; a module that registers the task may stand before a colon.

    Raises:
        InvalidInputError: no environment of that id is registered, or it is not one of this package.
    """
    module, _, name = identifier.rpartition(":")
    try:
        if module:
            importlib.import_module(module)
        task = gym.spec(name).kwargs.get("task")
    except gym.error.UnregisteredEnv as error:
        tasks = ", ".join(task.id for task in registered_tasks())
        raise InvalidInputError(f"environment id = {identifier!r}: {error} There are {tasks}") from error
    except (gym.error.Error, ImportError) as error:
        raise InvalidInputError(f"environment id = {identifier!r}: {error}") from error
    if task is None:
        raise InvalidInputError(
            f"environment id = {identifier!r} is not one of dq_marine; give one that dq_marine.register_task knows"
        )
    return writable_keywords(task_named(task))


def check_keywords(settings: EnvironmentSettings) -> None:
    """Check that the environment takes the keywords of its settings.

    Raises:
        InvalidInputError: it does not know one, or is not registered; the message lists those that it takes.
    """
    check_known(settings.id, settings.keywords, known_keywords(settings.id))


def with_changes(
    settings: EnvironmentSettings, keywords: Mapping[str, Any], *, identifier: str | None = None
) -> EnvironmentSettings:
    """Return settings with other keywords, checked to be among those that the environment takes.

    Args:
        settings: to begin with; where another environment is asked for, their keywords do not count.
        keywords: new values. A dictionary changes the entries that it has; None takes the environment's default.
        identifier: of another environment, or the short name of a task; None keeps the settings'. With a module that
            registers it before a colon, the same environment is no other.

    Raises:
        InvalidInputError: see `check_keywords`.
    """
    if identifier is not None and full_id(identifier) != settings.id:
        same = identifier.rpartition(":")[2] == settings.id
        keywords_before = settings.keywords if same else {}
        settings = EnvironmentSettings(id=full_id(identifier), keywords=keywords_before)
    changed = EnvironmentSettings(id=settings.id, keywords=_merged(settings.keywords, keywords))
    check_keywords(changed)
    return changed


def differences(one: EnvironmentSettings, other: EnvironmentSettings) -> dict[str, tuple[Any, Any]]:
    """Return the keywords in which settings of one environment differ, with both values; None is the default."""
    names = sorted({*one.keywords, *other.keywords})
    pairs = {name: (one.keywords.get(name), other.keywords.get(name)) for name in names}
    ids = {} if one.id == other.id else {"id": (one.id, other.id)}
    return ids | {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}


def _merged(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(old)
    for name, value in new.items():
        if value is None:
            merged.pop(name, None)
        elif isinstance(value, Mapping) and isinstance(merged.get(name), Mapping):
            merged[name] = _merged(merged[name], value)
        else:
            merged[name] = value
    return merged
