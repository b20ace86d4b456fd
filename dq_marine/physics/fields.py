"""Types of the fields of a vehicle file."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

Row6: TypeAlias = tuple[float, float, float, float, float, float]
Row3: TypeAlias = tuple[float, float, float]
Vector3: TypeAlias = Row3
Vector6: TypeAlias = Row6
Motion: TypeAlias = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]

MOTIONS: tuple[str, ...] = get_args(Motion)
"""Names of the six axes, in Fossen's order."""

NonNegative: TypeAlias = Annotated[float, Field(ge=0)]
Positive: TypeAlias = Annotated[float, Field(gt=0)]
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
