"""What all settings of preset files are: frozen, validated, and named in errors by their keys."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, Strict

Truth = Annotated[bool, Strict()]
Number = Annotated[float, Strict()]
Whole = Annotated[int, Strict()]
Positive = Annotated[Number, Field(gt=0.0)]
NonNegative = Annotated[Number, Field(ge=0.0)]
Fraction = Annotated[Number, Field(ge=0.0, le=1.0)]
Count = Annotated[Whole, Field(ge=1)]
Natural = Annotated[Whole, Field(ge=0)]


class Settings(BaseModel):
    """A table of a preset file: frozen, without unknown keys, without infinities.

    Fields of the types above are strict: true is no number, and "no" is neither true nor false.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
