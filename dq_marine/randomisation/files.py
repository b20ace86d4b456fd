"""Finding randomisation files by name and reading them."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.fields import Table
from dq_marine.randomisation.distributions import KINDS
from dq_marine.vehicles.validation import mistake

_FOLDER = Path(__file__).parent

Content = TypeVar("Content", bound=Table)


def randomisation_names() -> list[str]:
    """Return the names of the files that ship, sorted."""
    return sorted(path.stem for path in _FOLDER.glob("*.toml"))


def read_file(kind: type[Content], name_or_path: str | os.PathLike[str]) -> Content:
    """Return what a file says that ships by name or stands at a path.

    Raises:
        InvalidInputError: no such name or file, or the file is wrong; the message lists field, value and remedy.
    """
    text = os.fspath(name_or_path)
    if text in randomisation_names():
        return _read(kind, _FOLDER / f"{text}.toml")
    path = existing_file("randomisation", text)
    if path is not None:
        return _read(kind, path)
    raise InvalidInputError(
        f"there is no randomisation {shown(text)}; there are {', '.join(randomisation_names())}, and the path of an "
        "existing .toml file is taken too"
    )


def _read(kind: type[Content], path: Path) -> Content:
    try:
        return kind.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
    except ValidationError as error:  # before its base class, which TOML's errors share
        lines = [mistake(detail, _place(detail["loc"])) for detail in error.errors(include_url=False)]
        raise InvalidInputError(f"{path} is refused:\n  " + "\n  ".join(lines)) from error
    except (ValueError, RecursionError) as error:
        raise InvalidInputError(f"{path}: not a TOML file: {error}") from error
    except OSError as error:
        raise InvalidInputError(f"{path}: cannot be read: {error.strerror}") from error


def _place(parts: tuple[int | str, ...]) -> tuple[int | str, ...]:
    """Return where a mistake stands in the file: pydantic also names which of several forms it took a value for."""
    place = [part for part in parts if part not in ("one", "each")]
    kind = next((part for part in place if part in KINDS), None)
    if kind is not None:
        place.remove(kind)
    return tuple(place)
