"""What must hold before a training or a search begins: checked while nothing is written yet, and without torch."""

from __future__ import annotations

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.settings import TrainingSettings


def check_can_begin(settings: TrainingSettings) -> None:
    """Check that the environment can be made, and that the teacher, if there is one, can fly in it.

    Raises:
        InvalidInputError: the environment's keywords are wrong, or the teacher cannot fly in it.
        MissingDependencyError: a library that the teacher needs is not installed.
    """
    env = make_environment(settings.environment)
    try:
        if settings.imitation is not None:
            make_baseline(settings.imitation.teacher, env)
    finally:
        env.close()
