"""Making a vehicle of what a file or a caller says, with one line for each mistake."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.implausible import Implausible
from dq_marine.vehicles.model import Vehicle


def validated(
    content: Mapping[str, Any], origin: str, error_type: type[InvalidInputError] = InvalidInputError
) -> Vehicle:
    """Return the vehicle that `content` describes, as a vehicle file does.

    Args:
        content: tables and keys of a vehicle file.
        origin: where it comes from, for the message.
        error_type: what to raise.

    Raises:
        InvalidInputError: or `error_type`; the message lists field, value and remedy.
    """
    try:
        return Vehicle.model_validate(content)
    except ValidationError as error:
        lines = [mistake(detail, detail["loc"]) for detail in error.errors(include_url=False)]
        raise error_type(f"{origin} is refused:\n  " + "\n  ".join(lines)) from error


def mistake(detail: ErrorDetails, place: tuple[int | str, ...]) -> str:
    """Say one mistake: field = value: problem; remedy. `place` is where the field stands in the file."""
    cause: Any = detail.get("ctx", {}).get("error")
    if isinstance(cause, Implausible):
        return f"{cause.field} = {cause.value}: {cause.problem}; {cause.remedy}"
    field = ".".join(str(part) for part in place)
    if detail["type"] == "extra_forbidden":
        return f"{field} = {shown(detail['input'])}: unknown key; remove it or correct its spelling"
    if detail["type"] == "missing":
        return f"{field}: missing; add it"
    problem = _PROBLEMS.get(detail["type"], detail["msg"].removeprefix("Value error, "))
    return f"{field} = {shown(detail['input'])}: {problem}"


_PROBLEMS = {
    "finite_number": "not a finite number; give a measured or estimated value",
    "greater_than": "must be greater than 0; check sign and unit",
    "greater_than_equal": "must not be negative; check the sign",
    "float_type": "not a number; write it without quotes",
    "float_parsing": "not a number; write it without quotes",
    "too_short": "too few numbers; check the length",
    "too_long": "too many numbers; check the length",
}
