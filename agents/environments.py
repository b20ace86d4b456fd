"""Making the environment that settings ask for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import gymnasium as gym

from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.errors import InvalidInputError

DEFAULT_ENVIRONMENT = EnvironmentSettings(id="dq_marine/StationKeeping-v0")


def make_environment(settings: EnvironmentSettings, **keywords: Any) -> gym.Env[Any, Any]:
    """Make an environment.

    Args:
        settings: id and keywords.
        keywords: further ones; they win over those of the settings.

    Raises:
        InvalidInputError: the id is not registered, or a keyword or its value is wrong.
    """
    chosen = {**settings.keywords, **keywords}
    with _refusals_of(settings.id, chosen):
        # The checker wrapper re-examines every step; the tests of the environments do that once.
        return gym.make(settings.id, disable_env_checker=True, **chosen)


def space_shape(space: gym.Space[Any]) -> Any:
    """Return the shape of a space, or of each part of one with goals."""
    if isinstance(space, gym.spaces.Dict):
        return {name: part.shape for name, part in space.items()}
    return space.shape


def scenario_settings(scenario: Scenario) -> EnvironmentSettings:
    """Return the environment of a scenario."""
    return EnvironmentSettings(id=scenario.definition.id, keywords=scenario.keywords)


def make_environments(settings: EnvironmentSettings, count: int) -> gym.vector.VectorEnv[Any, Any, Any]:
    """Make environments that are stepped together; an ended episode is followed by a new one at the same step.

    Args:
        settings: id and keywords.
        count: how many.

    Raises:
        InvalidInputError: the id is not registered, or a keyword or its value is wrong.
    """
    with _refusals_of(settings.id, settings.keywords):
        mode = gym.vector.AutoresetMode.SAME_STEP
        return gym.make_vec(settings.id, num_envs=count, autoreset_mode=mode, **settings.keywords)


@contextmanager
def _refusals_of(identifier: str, keywords: dict[str, Any]) -> Iterator[None]:
    """Say what Gymnasium finds wrong in this package's words."""
    try:
        yield
    except gym.error.Error as error:
        raise InvalidInputError(f"environment id = {identifier!r}: {error}") from error
    except TypeError as error:
        raise InvalidInputError(f"environment keywords {sorted(keywords)} are refused: {error}") from error


def with_keywords(settings: EnvironmentSettings, **keywords: Any) -> EnvironmentSettings:
    """Return settings with further keywords; None leaves a keyword as it is."""
    given = {name: value for name, value in keywords.items() if value is not None}
    return settings.model_copy(update={"keywords": {**settings.keywords, **given}})


def marine(env: gym.Env[Any, Any]) -> MarineEnv:
    """Return the environment inside its wrappers.

    Raises:
        InvalidInputError: it is not one of this package.
    """
    inner = env.unwrapped
    if not isinstance(inner, MarineEnv):
        raise InvalidInputError(
            f"{inner} is not an environment of dq_marine; make one whose id starts with it"
        )
    return inner
