"""What must hold before a training or a search begins: checked while nothing is written yet, and without torch."""

from __future__ import annotations

from typing import Any, NamedTuple

import gymnasium as gym

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings
from dq_marine.agents.training.lessons import lessons_of
from dq_marine.agents.training.numbered_things import check_one_part, things_of
from dq_marine.envs.core.privileged import HIDDEN_BY, hidden_parts
from dq_marine.errors import InvalidInputError


def check_can_begin(settings: TrainingSettings) -> None:
    """Check that the environment of each lesson can be made, and that the teacher, if there is one, can fly in it.

    Raises:
        InvalidInputError: the environment's keywords are wrong, a level of the curriculum is unknown or shows other
            observations than the environment itself, the teacher cannot fly in it, it shows no numbered things that
            layers are to read alike, or a critic is to see what is hidden and is not.
        MissingDependencyError: a library that the teacher needs is not installed.
    """
    found = [_checked(lesson, lesson.learned_in) for lesson in lessons_of(settings)]
    for level, one in zip(settings.curriculum.levels if settings.curriculum else (), found, strict=False):
        if one.spaces != found[-1].spaces:
            raise InvalidInputError(
                f"curriculum.levels: at level {level!r} the observations or actions, or their bounds, are not those of "
                "the environment itself: no policy can learn both; leave the level out, or give the keyword that "
                "makes the difference"
            )
    if settings.while_learning and _checked(settings, settings.evaluated_in).spaces != found[-1].spaces:
        raise InvalidInputError(
            f"while_learning = {settings.while_learning} changes the observations or actions, or their bounds: the "
            "policy could not fly in the environment that it is for; give keywords that leave them as they are"
        )
    for name in settings.privileged_critic:
        if name not in found[-1].hidden:
            raise InvalidInputError(
                f"privileged_critic has {name!r}, but {settings.environment.id} with {settings.environment.keywords} "
                f"hides none of it from the agent; give {HIDDEN_BY[name]}, or leave {name!r} out"
            )


class _Found(NamedTuple):
    """What an environment to learn in is like.

    Attributes:
        spaces: of observations and of actions.
        hidden: names of what only the simulator knows.
    """

    spaces: tuple[gym.Space[Any], gym.Space[Any]]
    hidden: tuple[str, ...]


def _checked(settings: TrainingSettings, environment: EnvironmentSettings) -> _Found:
    """Return what an environment is like in which the teacher can fly and the network read what is shown."""
    env = make_environment(environment)
    try:
        if settings.imitation is not None:
            make_baseline(settings.imitation.teacher, env)
        if settings.network.set_layers:
            check_one_part(env.observation_space)
            things_of(marine(env).observations)
        return _Found((env.observation_space, env.action_space), hidden_parts(marine(env)))
    finally:
        env.close()
