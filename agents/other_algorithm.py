"""A task's preset with another algorithm than its own: what belongs to the task stays, the rest is the algorithm's."""

from __future__ import annotations

from typing import Any

from dq_marine.agents.algorithm_settings import ReplaySettings, RolloutSettings
from dq_marine.agents.preset_files import read_settings, validate_settings
from dq_marine.agents.settings import ImitationSettings, TrainingSettings

OF_THE_TASK = (
    ("algorithm", "gamma"),
    ("network", "set_layers"),
    ("normalisation", "symlog"),
    ("evaluation", "episodes"),
)
"""Settings within tables that belong to the task."""

COPY = ImitationSettings(rounds=1, forgetful=True)
"""With which an algorithm that learns from a memory begins where the task's preset has none."""

RATE_FROM_COPY = 2e-4
"""At which it begins to learn then: a fifth of that from nothing."""

EVALUATED_FROM_COPY = 2_000
"""Timesteps between its evaluations then: what it does may come and go, and the best is kept."""


def with_algorithm(task: TrainingSettings, algorithm: str) -> TrainingSettings:
    """Return settings to learn the same with the preset that an algorithm is known by.

    The task's are the environment and how it differs while it is learned in, how far ahead returns look, which things
    in an observation are read alike, the logarithm before its normalisation, lessons, what the critic sees, and the
    copy that learning begins with. Steps, rates and networks are the algorithm's. One that learns from a memory begins
    as a copy of the controller in any case, because the steps that it can take are too few to find out most tasks; they
    are small ones then, and often evaluated.

    Args:
        task: settings of the task, for whichever algorithm.
        algorithm: name of another one, which is that of its preset, too.

    Raises:
        InvalidInputError: the algorithm cannot learn what the settings ask for.
    """
    own = read_settings(algorithm, TrainingSettings)
    content, of_task = own.model_dump(), task.model_dump()
    for name in ("environment", "while_learning", "curriculum", "privileged_critic"):
        content[name] = of_task[name]
    for table, name in OF_THE_TASK:
        content[table][name] = of_task[table][name]
    content["imitation"] = of_task["imitation"]
    if isinstance(own.algorithm, ReplaySettings):
        _begin_from_copy(content)
    elif isinstance(task.algorithm, RolloutSettings):
        content["algorithm"]["log_std_init"] = task.algorithm.log_std_init
    elif task.imitation is not None:
        content["imitation"]["keeping"] = None
    return validate_settings(content, TrainingSettings, source=f"what was asked for, with {algorithm}")


def _begin_from_copy(content: dict[str, Any]) -> None:
    """Let settings of an algorithm that learns from a memory begin with a copy, and go on by small steps."""
    content["imitation"] = content["imitation"] or COPY.model_dump()
    content["evaluation"]["every"] = EVALUATED_FROM_COPY
    content["algorithm"] |= {"learning_rate": RATE_FROM_COPY, "learning_starts": 0}
