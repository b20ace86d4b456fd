"""What a curriculum consists of: the settings of each lesson. Without torch, so that they can be checked early."""

from __future__ import annotations

from pathlib import Path

from dq_marine.agents.environments import with_keywords
from dq_marine.agents.settings import TrainingSettings
from dq_marine.errors import InvalidInputError


def lessons_of(settings: TrainingSettings) -> list[TrainingSettings]:
    """Return the settings of each lesson: a run's at each level of its curriculum, and at last its own."""
    levels = settings.curriculum.levels if settings.curriculum is not None else ()
    return [*(_at_level(settings, level) for level in levels), settings]


def check_lesson(settings: TrainingSettings, number: int, source: Path) -> None:
    """Check that a run has the lesson that its snapshot was at.

    Raises:
        InvalidInputError: it has not.
    """
    count = len(lessons_of(settings))
    if number >= count:
        raise InvalidInputError(
            f"{source} was at lesson {number}, counted from 0, and run.json has {count}; restore both from one copy, "
            "or train anew with --force"
        )


def _at_level(settings: TrainingSettings, level: str) -> TrainingSettings:
    return settings.model_copy(update={"environment": with_keywords(settings.environment, level=level)})
