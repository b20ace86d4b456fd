"""Finding scenarios by name, and reading their files."""

from __future__ import annotations

import functools
import os
import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from dq_marine.checks import existing_file, shown
from dq_marine.envs.core.registry import short_name, task_called
from dq_marine.envs.scenarios.model import Scenario, ScenarioFile
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles.validation import mistake

FOLDER = Path(__file__).parent
"""Of the files that ship."""

ENDING = ".toml"


def scenarios_of(task: str | None = None) -> tuple[Scenario, ...]:
    """Return the scenarios that ship, in the order of the files: of a task, by its name or id; None for all.

    Raises:
        InvalidInputError: there is no such task.
    """
    identifier = None if task is None else task_called(task).id
    return tuple(one for one in _shipped() if identifier in (None, one.definition.id))


def scenario_names(task: str | None = None) -> list[str]:
    """Return the full names of the scenarios that ship, such as "StationKeeping/calm"; see `scenarios_of`."""
    return [one.full_name for one in scenarios_of(task)]


def load_scenario(scenario: Scenario | str | os.PathLike[str], *, task: str | None = None) -> Scenario:
    """Return a scenario.

    Args:
        scenario: one that ships, as "StationKeeping/calm", or by its last part where `task` or nothing else leaves a
            doubt; or the path of a TOML file with one scenario; or such a path, a colon and the name of one in it.
        task: that it must be of, by name or id.

    Raises:
        InvalidInputError: there is none, or more than one, or the file is wrong; the message lists field, value and
            remedy.
    """
    if isinstance(scenario, Scenario):
        return _of_task(scenario, task)
    if not isinstance(scenario, str | os.PathLike):
        raise InvalidInputError(
            f"scenario = {shown(scenario)}; give a name, the path of a TOML file, or a Scenario"
        )
    text = os.fspath(scenario)
    path, _, name = text.rpartition(":")
    if text.endswith(ENDING):
        path, name = text, ""
    if path.endswith(ENDING):
        return _of_task(_from_file(path, name), task)
    return _named(text, task)


def read_scenarios(path: str | os.PathLike[str]) -> tuple[Scenario, ...]:
    """Return the scenarios of a file.

    A vehicle's file that a scenario names is looked for beside the scenario's file first.

    Raises:
        InvalidInputError: there is no such file, or it is wrong; the message lists field, value and remedy.
    """
    file = existing_file("scenario", path)
    if file is None:
        raise InvalidInputError(
            f"there is no file {shown(os.fspath(path))}; `dq-marine scenarios` lists those by name"
        )
    try:
        content = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidInputError(f"{file}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise InvalidInputError(f"{file}: not a TOML file: {error}") from error
    try:
        read = ScenarioFile.model_validate(content)
    except ValidationError as error:
        lines = [mistake(detail, detail["loc"]) for detail in error.errors(include_url=False)]
        raise InvalidInputError(f"{file} is refused:\n  " + "\n  ".join(lines)) from error
    return tuple(_with_vehicle_beside(one, file.parent) for one in read.scenario)


@functools.cache
def _shipped() -> tuple[Scenario, ...]:
    return tuple(one for path in sorted(FOLDER.glob(f"*{ENDING}")) for one in read_scenarios(path))


def _named(text: str, task: str | None) -> Scenario:
    """Return a scenario that ships by its full name, or by its last part if that leaves no doubt."""
    of, _, name = text.rpartition("/")
    candidates = [one for one in scenarios_of(of or task) if one.name == name]
    if not candidates:
        there = (
            ", ".join(scenario_names(of or task)) if of or task else "those that `dq-marine scenarios` lists"
        )
        raise InvalidInputError(
            f"there is no scenario {shown(text)}; there are {there or 'none'}, and the path of a .toml file is taken "
            "too"
        )
    if len(candidates) > 1:
        names = ", ".join(one.full_name for one in candidates)
        raise InvalidInputError(f"scenario = {shown(text)} may be any of {names}; give one of these")
    return _of_task(candidates[0], task)


def _from_file(path: str, name: str) -> Scenario:
    found = read_scenarios(path)
    names = [one.name for one in found]
    if not name and len(found) == 1:
        return found[0]
    if name not in names:
        raise InvalidInputError(
            f"{path} has the scenarios {', '.join(names)}, and {shown(name) if name else 'none'} is asked for; give "
            f"one of them, as in {path}:{names[0]}"
        )
    return found[names.index(name)]


def _of_task(scenario: Scenario, task: str | None) -> Scenario:
    if task is not None and task_called(task).id != scenario.definition.id:
        raise InvalidInputError(
            f"the scenario {scenario.full_name} is of {scenario.definition.id}, not of {shown(task)}; give one of "
            f"{short_name(task_called(task))}"
        )
    return scenario


def _with_vehicle_beside(scenario: Scenario, folder: Path) -> Scenario:
    vehicle: Any = scenario.keywords.get("vehicle")
    if not isinstance(vehicle, str) or not vehicle.endswith(ENDING) or not (folder / vehicle).is_file():
        return scenario
    keywords = {**scenario.keywords, "vehicle": str((folder / vehicle).resolve())}
    return scenario.model_copy(update={"keywords": keywords})
