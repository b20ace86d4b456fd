"""Reading preset files.

A preset may begin with `based_on`, the name of another preset or the path of its file. Then it gives only what differs:
keys that it or one of its tables leaves out are the other's. A table within a table, such as the keywords of the
environment, replaces the other's as a whole.
"""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.strict_settings import Settings
from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError

PRESET_FOLDER = Path(__file__).parent / "presets"

BASE = "based_on"
"""The key that names the preset whose settings are taken where a file says nothing."""

SettingsType = TypeVar("SettingsType", bound=Settings)


def preset_names() -> list[str]:
    """Return the names of the shipped presets, sorted."""
    return sorted(path.stem for path in PRESET_FOLDER.glob("*.toml"))


def read_settings(preset: str | os.PathLike[str], model: type[SettingsType]) -> SettingsType:
    """Read a preset.

    Args:
        preset: name of a shipped preset, or the path of a TOML file.
        model: what the file is to hold.

    Raises:
        InvalidInputError: there is no such preset, or it is wrong; the message lists field, value and remedy.
    """
    path = _preset_path(preset)
    return validate_settings(_content(path), model, source=str(path))


def read_environment(preset: str | os.PathLike[str]) -> EnvironmentSettings:
    """Read the environment that a preset trains in.

    Raises:
        InvalidInputError: there is no such preset, or its table `environment` is missing or wrong.
    """
    path = _preset_path(preset)
    content = _content(path)
    if "environment" not in content:
        raise InvalidInputError(f"{path} has no table [environment]; give a preset that has one")
    return validate_settings(content["environment"], EnvironmentSettings, source=f"{path}: [environment]")


def _content(path: Path, derived: tuple[Path, ...] = ()) -> dict[str, Any]:
    """Return what a file says, completed by what it is based on.

    Args:
        path: of the file.
        derived: files that are based on it, the nearest last.
    """
    content = _parsed(path)
    if BASE not in content:
        return content
    base = content.pop(BASE)
    if not isinstance(base, str):
        raise InvalidInputError(f"{path}: {BASE} = {shown(base)}; give the name of a preset or a file's path")
    found, chain = _preset_path(base), (*derived, path)
    if found.resolve() in [one.resolve() for one in chain]:
        raise InvalidInputError(f"{path}: {BASE} = {base!r} leads back to it; base it on another preset")
    return _over(_content(found, chain), content)


def _over(base: dict[str, Any], content: dict[str, Any]) -> dict[str, Any]:
    """Return `base` with what `content` says in its place."""
    tables = {
        name: {**base[name], **value}
        for name, value in content.items()
        if isinstance(value, dict) and isinstance(base.get(name), dict)
    }
    return base | content | tables


def _parsed(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidInputError(f"{path}: not a TOML file: {error}") from error
    except OSError as error:
        raise InvalidInputError(f"{path}: cannot be read: {error.strerror}") from error


def validate_settings(content: Any, model: type[SettingsType], *, source: str) -> SettingsType:
    """Return `content`, which came from `source`, as settings.

    Raises:
        InvalidInputError: it is wrong; the message lists source, field, value and remedy.
    """
    try:
        return model.model_validate(content)
    except ValidationError as error:
        lines = [_line(detail) for detail in error.errors(include_url=False)]
        raise InvalidInputError(f"{source} is refused:\n  " + "\n  ".join(lines)) from error


def _preset_path(preset: str | os.PathLike[str]) -> Path:
    text = os.fspath(preset)
    if text in preset_names():
        return PRESET_FOLDER / f"{text}.toml"
    path = existing_file("preset", text)
    if path is None:
        raise InvalidInputError(
            f"there is no preset or file {shown(text)}; the presets are {', '.join(preset_names())}, and the path of "
            "an existing .toml file is taken too"
        )
    return path


def _line(detail: ErrorDetails) -> str:
    """Say one mistake: field = value: problem."""
    field = ".".join(str(part) for part in detail["loc"])
    if detail["type"] == "extra_forbidden":
        return f"{field} = {detail['input']!r}: unknown key; remove it or correct its spelling"
    if detail["type"] == "missing":
        return f"{field}: missing; add it"
    problem = detail["msg"].removeprefix("Value error, ")
    if detail["type"] == "value_error" and isinstance(detail["input"], dict) and field:
        return f"{field}: {problem}"  # of a whole table, whose own words name the value
    return f"{field} = {detail['input']!r}: {problem}" if field else problem
