"""Files of references, one for each vehicle of the catalogue, and how they are read."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Annotated

from pydantic import Field, ValidationError

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.fields import Table
from dq_marine.validation.trials import Trial
from dq_marine.vehicles.validation import mistake

_FOLDER = Path(__file__).parent

LARGEST_FILE = 1_000_000
"""Of references [bytes]."""


class References(Table):
    """What a vehicle is held against.

    Attributes:
        trial: the trials, each with the numbers it should give.
        silence: what is known of why there are none, or no more.
    """

    trial: tuple[Trial, ...] = ()
    silence: Annotated[str, Field(max_length=1000)] = ""


def validated_vehicles() -> list[str]:
    """Return the names of the vehicles of the catalogue that have references, sorted."""
    return sorted(path.stem for path in _FOLDER.glob("*.toml"))


def load_references(references: str | os.PathLike[str]) -> References:
    """Return the references of a vehicle of the catalogue by its name, or those in a file ending in `.toml`.

    Raises:
        InvalidInputError: there are none, or the file is wrong; the message lists field, value and remedy.
    """
    text = os.fspath(references)
    path = _FOLDER / f"{text}.toml" if text in validated_vehicles() else existing_file("references", text)
    if path is None:
        raise InvalidInputError(
            f"there are no references {shown(text)}; those of {', '.join(validated_vehicles())} are known, and the "
            "path of an existing .toml file is taken too"
        )
    return _read(path)


def _read(path: Path) -> References:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise InvalidInputError(f"{path} has more than {LARGEST_FILE} bytes; no file of references has")
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidInputError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise InvalidInputError(f"{path}: not a file of references: {error}") from error
    try:
        return References.model_validate(content)
    except ValidationError as error:
        lines = [mistake(detail, detail["loc"]) for detail in error.errors(include_url=False)]
        raise InvalidInputError(f"{path} is refused:\n  " + "\n  ".join(lines)) from error
