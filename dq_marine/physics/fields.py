"""Types of the fields of a vehicle file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self, TypeAlias, get_args

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from dq_marine.checks import shown
from dq_marine.physics.implausible import Implausible

Row6: TypeAlias = tuple[float, float, float, float, float, float]
Row3: TypeAlias = tuple[float, float, float]
Vector3: TypeAlias = Row3
Vector6: TypeAlias = Row6
Motion: TypeAlias = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]

MOTIONS: tuple[str, ...] = get_args(Motion)
"""Names of the six axes, in Fossen's order."""

LARGEST_NUMBER = 1e20
"""Of a vehicle file. The largest in the catalogue, a moment of inertia of a tanker, is below 1e14."""

SMALLEST_NUMBER = 1e-20
"""Of a vehicle file, where a number must be above 0: products of several, by which others are divided, stay so."""


def _not_vanishing(value: float) -> float:
    """Return a number that must be above 0, if it is not so small that its products are 0."""
    if 0.0 < value < SMALLEST_NUMBER:
        raise ValueError(
            f"no ship has a number below {SMALLEST_NUMBER:g} in SI units; check exponent and unit"
        )
    return value


NonNegative: TypeAlias = Annotated[float, Field(ge=0)]
Positive: TypeAlias = Annotated[float, Field(gt=0), AfterValidator(_not_vanishing)]
Share: TypeAlias = Annotated[float, Field(ge=0, le=1)]
Share6: TypeAlias = tuple[Share, Share, Share, Share, Share, Share]
NonNegative6: TypeAlias = tuple[NonNegative, NonNegative, NonNegative, NonNegative, NonNegative, NonNegative]


def _square(size: int) -> Any:
    """Return a validator that turns `size` numbers into a diagonal matrix and leaves rows as they are."""

    def expand(value: Any) -> Any:
        if not isinstance(value, list | tuple):
            raise ValueError(f"give {size} numbers (a diagonal) or {size} rows of {size} numbers")
        rows = any(isinstance(row, list | tuple) for row in value)
        shaped = len(value) == size and (
            not rows or all(isinstance(row, list | tuple) and len(row) == size for row in value)
        )
        if not shaped:
            raise ValueError(f"give {size} numbers (a diagonal) or {size} rows of {size} numbers")
        if rows:
            return value
        return [[entry if i == j else 0.0 for j in range(size)] for i, entry in enumerate(value)]

    return expand


Matrix3: TypeAlias = Annotated[tuple[Row3, Row3, Row3], BeforeValidator(_square(3))]
Matrix6: TypeAlias = Annotated[tuple[Row6, Row6, Row6, Row6, Row6, Row6], BeforeValidator(_square(6))]


class Table(BaseModel):
    """A table of a vehicle file: frozen, without unknown keys, without NaN or infinity, without coercion."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @model_validator(mode="after")
    def _can_be_computed_with_and_shown(self) -> Self:
        for name in type(self).model_fields:
            for leaf in _leaves(getattr(self, name)):
                if isinstance(leaf, str):
                    _check_text(name, leaf)
                elif abs(leaf) > LARGEST_NUMBER:
                    raise Implausible(
                        name,
                        f"{leaf:g}",
                        f"no ship has a number beyond {LARGEST_NUMBER:g} in SI units",
                        "check exponent and unit",
                    )
        return self


def _leaves(value: Any) -> Iterator[float | str]:
    """Yield the numbers and texts of a field, of nested tuples too; tables look after their own."""
    if isinstance(value, float | int | str):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from _leaves(part)


def _check_text(name: str, text: str) -> None:
    if not text.replace("\n", "").replace("\t", "").isprintable():
        raise Implausible(name, shown(text), "it has control characters", "write it in printable characters")
