"""What must hold before a training or a search begins: checked while nothing is written yet, and without torch."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.lessons import lessons_of
from dq_marine.envs.core.privileged import hides_anything
from dq_marine.errors import InvalidInputError


def check_can_begin(settings: TrainingSettings) -> None:
    """Check that the environment of each lesson can be made, and that the teacher, if there is one, can fly in it.

    Raises:
        InvalidInputError: the environment's keywords are wrong, a level of the curriculum is unknown or shows other
            observations than the environment itself, or the teacher cannot fly in it.
        MissingDependencyError: a library that the teacher needs is not installed.
    """
    spaces = [_checked_spaces(lesson) for lesson in lessons_of(settings)]
    for level, found in zip(settings.curriculum.levels if settings.curriculum else (), spaces, strict=False):
        if found != spaces[-1]:
            raise InvalidInputError(
                f"curriculum.levels: at level {level!r} the observations or actions, or their bounds, are not those of "
                "the environment itself: no policy can learn both; leave the level out, or give the keyword that "
                "makes the difference"
            )


def _checked_spaces(settings: TrainingSettings) -> tuple[gym.Space[Any], gym.Space[Any]]:
    """Return the spaces of observations and actions of an environment in which the teacher can fly."""
    env = make_environment(settings.learned_in)
    try:
        if settings.imitation is not None:
            make_baseline(settings.imitation.teacher, env)
        if settings.privileged_critic and not hides_anything(marine(env)):
            raise InvalidInputError(
                f"privileged_critic = true, but {settings.environment.id} with {settings.environment.keywords} hides "
                "nothing from the agent: its water is still, all its episodes fly one vehicle, and what is observed is "
                "true; give a current, randomise or sensors, or leave privileged_critic out"
            )
        return env.observation_space, env.action_space
    finally:
        env.close()
