"""From what people type to settings: the environment to fly in, the training to do."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from dq_marine.agents.environments import with_keywords
from dq_marine.agents.pilots import common_environment
from dq_marine.agents.preset_files import read_settings, validate_settings
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import vehicle_names

DEFAULT_ALGORITHM = "ppo"


def requested_environment(
    runs: Sequence[Path], *, vehicle: str | None, current: str | None
) -> EnvironmentSettings:
    """Return the environment of training runs, or station keeping without any, with another vehicle or current.

    Args:
        runs: folders of training runs.
        vehicle: a catalogue name or a file's path; None keeps the environment's.
        current: as `parsed_current` takes it; None keeps the environment's.

    Raises:
        InvalidInputError: a folder holds no run, the runs disagree, or the current is not one.
    """
    return _changed(common_environment(runs), vehicle, current)


def requested_training(
    *,
    algorithm: str | None,
    preset: str | None,
    timesteps: int | None,
    envs: int | None,
    vehicle: str | None,
    current: str | None,
) -> TrainingSettings:
    """Return a preset's settings with what was asked for in its place.

    Args:
        algorithm: "ppo" or "sac", for the preset of that name; None takes the preset's, or "ppo".
        preset: a name or a file's path; None takes the algorithm's.
        timesteps: in all; None keeps the preset's, and so on for the others.
        envs: environments to learn from.
        vehicle: a catalogue name or a file's path.
        current: as `parsed_current` takes it.

    Raises:
        InvalidInputError: the preset or an option is wrong, or they contradict each other.
    """
    source = preset or algorithm or DEFAULT_ALGORITHM
    settings = read_settings(source, TrainingSettings)
    if algorithm is not None and algorithm != settings.algorithm.name:
        raise InvalidInputError(
            f"--algorithm {algorithm} does not go with --preset {preset}, which is for {settings.algorithm.name}; "
            "leave --algorithm out"
        )
    asked = {"timesteps": timesteps, "envs": envs}
    content = settings.model_dump()
    content.update({name: value for name, value in asked.items() if value is not None})
    content["environment"] = _changed(settings.environment, vehicle, current).model_dump()
    return validate_settings(content, TrainingSettings, source=f"{source} with these options")


def parsed_current(text: str) -> float | list[float]:
    """Return a speed from "0.3", or three components from "0.2,-0.1,0" [m/s].

    Raises:
        InvalidInputError: it is neither.
    """
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 3):
        raise InvalidInputError(
            f"--current {text} is neither a speed nor three components; give 0.3 or 0.2,-0.1,0 (no spaces) [m/s]"
        )
    return numbers[0] if len(numbers) == 1 else numbers


def _changed(
    environment: EnvironmentSettings, vehicle: str | None, current: str | None
) -> EnvironmentSettings:
    return with_keywords(
        environment,
        vehicle=None if vehicle is None else _findable(vehicle),
        current=None if current is None else parsed_current(current),
    )


def _findable(vehicle: str) -> str:
    """Return a file's absolute path, so that a run can be flown from any folder; a catalogue name as it is."""
    path = Path(vehicle).expanduser()
    if vehicle in vehicle_names() or not path.is_file():
        return vehicle
    return str(path.resolve())
