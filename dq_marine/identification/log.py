"""A log of a vehicle's motion and of what drove it: read from CSV, checked, in SI units."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError
from dq_marine.identification.columns import (
    EULER,
    POSITION,
    QUANTITIES,
    QUATERNION,
    VELOCITY,
    Column,
    recognised,
)
from dq_marine.identification.commands import Inputs, Values, inputs_of
from dq_marine.identification.log_checks import check_log
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

MOST_ROWS = 60_000
"""Rows of a log: 100 minutes at 10 Hz. All of them are simulated for each parameter, and kept in memory."""


@dataclass(frozen=True)
class Log:
    """What was measured at n instants, NaN where a sensor had no reading, and what drove the vehicle.

    Attributes:
        name: of the file.
        time: [s], shape (n,), nearly equally spaced.
        position_ned: of the body origin [m], shape (n, 3).
        quaternion_body_to_ned: scalar first, of unit length, shape (n, 4).
        velocity_body: over ground, Fossen's order [m/s, rad/s], shape (n, 6).
        inputs: wrenches or commands, each held from its instant to the next.
    """

    name: str
    time: Array
    position_ned: Array
    quaternion_body_to_ned: Array
    velocity_body: Array
    inputs: Inputs

    @property
    def period(self) -> float:
        """Time between instants, the mean [s]: what the median differs by would add up over a log."""
        return self.duration / (len(self.time) - 1)

    @property
    def duration(self) -> float:
        """[s]."""
        return float(self.time[-1] - self.time[0])


def read_log(path: str | os.PathLike[str], vehicle: Vehicle) -> Log:
    """Return the log in a CSV file, whose header has a quantity and its unit for each column.

    Needed are `time_s`; the attitude, as `roll_deg`, `pitch_deg`, `heading_deg` or `q_scalar`, `q_x`, `q_y`, `q_z`; the
    velocity `u_m_s`, `v_m_s`, `w_m_s`; and what drives the vehicle, see `inputs_of`. `p_rad_s`, `q_rad_s`, `r_rad_s`
    and `north_m`, `east_m`, `down_m` (or `depth_m`) are used where they are there. An empty field is a sensor without a
    reading at that instant. Columns of other names are passed over.

    Args:
        path: of the file.
        vehicle: that was logged; its channels and limits give commands their meaning.

    Raises:
        InvalidInputError: the file cannot be read, a column is missing or has a wrong unit, a field is no number, time
            does not increase evenly, or a magnitude betrays a wrong unit.
    """
    file = existing_file("log", path)
    if file is None:
        raise InvalidInputError(f"there is no file {shown(os.fspath(path))}; give the CSV file of a log")
    headers, rows = _cells(file)
    known = recognised(headers, QUANTITIES)
    place = {header: index for index, header in enumerate(headers)}

    def values(column: Column) -> Array:
        return column.factor * _numbers(file, rows, column.header, place[column.header])

    inputs = inputs_of(file.name, headers, vehicle, values)
    _check_present(file.name, known)
    n = len(rows)
    blank = np.full(n, np.nan)
    position = [values(known[name]) if name in known else blank for name in POSITION]
    if "depth" in known:
        position[2] = values(known["depth"])
    log = Log(
        file.name,
        values(known["time"]),
        np.stack(position, axis=1),
        _attitude(file.name, headers, known, values),
        np.stack([values(known[name]) if name in known else blank for name in VELOCITY], axis=1),
        inputs,
    )
    check_log(log)
    return log


def _cells(file: Path) -> tuple[list[str], list[list[str]]]:
    """Return the header and the rows, as texts."""
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            lines = [line for line in csv.reader(stream) if line]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InvalidInputError(
            f"{file} cannot be read as CSV: {error}; give a text file in UTF-8"
        ) from error
    if len(lines) < 2:
        raise InvalidInputError(f"{file} has {len(lines)} lines; give a header and a row for each instant")
    headers, rows = [name.strip() for name in lines[0]], lines[1:]
    if len(rows) > MOST_ROWS:
        raise InvalidInputError(
            f"{file} has {len(rows):,} rows; give at most {MOST_ROWS:,}: a part of it, or fewer rows a second"
        )
    for number, row in enumerate(rows, start=2):
        if len(row) != len(headers):
            raise InvalidInputError(
                f"{file}, line {number}, has {len(row)} fields, but the header {len(headers)}; mend it"
            )
    return headers, rows


def _numbers(file: Path, rows: Sequence[Sequence[str]], header: str, index: int) -> Array:
    """Return a column; NaN where a field is empty."""
    column = np.full(len(rows), np.nan)
    for number, row in enumerate(rows):
        text = row[index].strip()
        if not text:
            continue
        try:
            column[number] = float(text)
        except ValueError:
            column[number] = np.nan
        if not np.isfinite(column[number]):
            raise InvalidInputError(
                f"{file}, line {number + 2}: {header} = {shown(text)} is no finite number; leave the field empty where "
                "there is no reading"
            )
    return column


def _check_present(name: str, known: dict[str, Column]) -> None:
    if "time" not in known:
        raise InvalidInputError(f"{name} has no column time_s; add it")
    if "depth" in known and "down" in known:
        raise InvalidInputError(f"{name} has depth_m and down_m, which are the same; keep one")
    missing = [part for part in VELOCITY[:3] if part not in known]
    if missing:
        names = ", ".join(f"{part}_m_s" for part in missing)
        raise InvalidInputError(
            f"{name} has no column {names}: velocity over ground in the body frame; add it"
        )


def _attitude(name: str, headers: Sequence[str], known: dict[str, Column], values: Values) -> Array:
    """Return attitudes, shape (n, 4); those of the quaternion, if there is one."""
    if set(QUATERNION) <= set(headers):
        quaternion = np.stack([values(Column(part, part, 1.0)) for part in QUATERNION], axis=1)
        lengths = np.linalg.norm(quaternion, axis=1)
        bad = np.flatnonzero(np.abs(lengths - 1.0) > 1e-2)
        if bad.size:
            raise InvalidInputError(
                f"{name}, line {bad[0] + 2}: the quaternion has length {lengths[bad[0]]:.4g}; give unit quaternions, "
                "scalar first"
            )
        return np.asarray(quaternion / lengths[:, None])
    missing = [part for part in EULER if part not in known]
    if missing:
        names = ", ".join(f"{part}_deg" for part in missing)
        raise InvalidInputError(
            f"{name} has no column {names}; add it, or the attitude as {', '.join(QUATERNION)}"
        )
    angles = np.stack([values(known[part]) for part in EULER], axis=1)
    for part, angle in zip(EULER[:2], angles.T, strict=False):
        largest = float(np.nanmax(np.abs(angle), initial=0.0))
        if largest > 2.0 * np.pi:
            raise InvalidInputError(
                f"{name}: {known[part].header} reaches {largest / known[part].factor:.4g}, more than a full turn; "
                "check the unit in the column's name"
            )
    return np.array([quaternion_from_euler(*row) for row in angles.tolist()])
