"""Added mass and damping of a hull by the frequency of its motion, as strip and panel programs give them."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any, Self

import numpy as np
from pydantic import Field, model_validator

from dq_marine.checks import existing_file
from dq_marine.physics.fields import MOTIONS, Matrix6, Positive, Table
from dq_marine.physics.implausible import Implausible

COLUMNS = ("frequency", "force", "motion", "added_mass", "damping")
"""Columns of a file."""


class RadiationTable(Table):
    """Added mass and damping by the waves that a hull makes, about the body origin. Forces of a sea follow from them.

    Attributes:
        frequencies: rising [rad/s].
        added_mass: a 6x6 matrix for each, in Fossen's order [kg, kg m, kg m^2].
        damping: the same [N s/m, N s, N m s].
        infinite: added mass at infinite frequency; None for that of the vehicle.
    """

    frequencies: tuple[Positive, ...] = Field(min_length=1)
    added_mass: tuple[Matrix6, ...]
    damping: tuple[Matrix6, ...]
    infinite: Matrix6 | None = None

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        count = len(self.frequencies)
        for name in ("added_mass", "damping"):
            if len(getattr(self, name)) != count:
                raise Implausible(
                    f"radiation.{name}",
                    f"{len(getattr(self, name))} matrices",
                    f"there are {count} frequencies",
                    "give a matrix for each",
                )
        if np.any(np.diff(self.frequencies) <= 0.0):
            raise Implausible(
                "radiation.frequencies",
                "not rising",
                "each is to be larger than the one before",
                "sort them, and give each once",
            )
        return self


def read_radiation(file: Path) -> dict[str, Any]:
    """Return the entries of a `RadiationTable` from a CSV file.

    It has a line for each frequency [rad/s], force and motion (surge, sway, heave, roll, pitch, yaw), with added mass
    and damping in SI units; what has no line is zero.

    Raises:
        OSError: the file cannot be read.
        ValueError: it is no regular file, or too large; a column is missing, a name unknown, or a number none; the
            message names the line.
    """
    if existing_file("radiation", file) is None:
        raise ValueError("there is no such file")
    entries: dict[float, dict[str, list[list[float]]]] = {}
    with file.open(newline="", encoding="utf-8") as lines:
        rows = csv.DictReader(lines)
        missing = [name for name in COLUMNS if name not in (rows.fieldnames or ())]
        if missing:
            raise ValueError(f"columns {missing} are missing; give {', '.join(COLUMNS)}")
        for row in rows:
            unknown = {row["force"], row["motion"]} - set(MOTIONS)
            if unknown:
                raise ValueError(f"line {rows.line_num} has {unknown}; names are {', '.join(MOTIONS)}")
            i, j = MOTIONS.index(row["force"]), MOTIONS.index(row["motion"])
            try:
                numbers = {name: float(row[name]) for name in ("frequency", "added_mass", "damping")}
            except (TypeError, ValueError) as error:
                raise ValueError(f"line {rows.line_num}: {error}; give numbers") from error
            at = entries.setdefault(
                numbers["frequency"],
                {name: np.zeros((6, 6)).tolist() for name in ("added_mass", "damping")},
            )
            at["added_mass"][i][j], at["damping"][i][j] = numbers["added_mass"], numbers["damping"]
    frequencies = sorted(entries)
    return {
        "frequencies": frequencies,
        "added_mass": [entries[frequency]["added_mass"] for frequency in frequencies],
        "damping": [entries[frequency]["damping"] for frequency in frequencies],
    }
