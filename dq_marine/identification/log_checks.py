"""Whether a log can be used: its times, its length, and magnitudes that betray a wrong unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.identification.log import Log

FEWEST_ROWS = 100
LARGEST_GAP = 1.5
"""Over the mean time between rows."""

SMALLEST_GAP = 0.5
FASTEST = 60.0
"""Speed of a vehicle [m/s]."""

FASTEST_TURN = 20.0
"""Angular velocity of a vehicle [rad/s]."""


def check_log(log: Log) -> None:
    """Check a log that has been read.

    Raises:
        InvalidInputError: see `read_log`.
    """
    if len(log.time) < FEWEST_ROWS:
        raise InvalidInputError(
            f"{log.name} has {len(log.time)} rows; give at least {FEWEST_ROWS}, better ten minutes of motion"
        )
    _check_time(log)
    _check_readings(log)
    _check_speed(log, slice(0, 3), FASTEST, "u, v, w", "m/s")
    _check_speed(log, slice(3, 6), FASTEST_TURN, "p, q, r", "rad/s")


def _check_time(log: Log) -> None:
    if np.isnan(log.time).any():
        line = int(np.flatnonzero(np.isnan(log.time))[0]) + 2
        raise InvalidInputError(f"{log.name}, line {line}: there is no time; give one for each row")
    gaps = np.diff(log.time)
    if gaps.min() <= 0.0:
        row = int(gaps.argmin())
        raise InvalidInputError(
            f"{log.name}, line {row + 3}: time = {log.time[row + 1]:.9g} s after {log.time[row]:.9g} s; give rows in "
            "the order of time, each instant once"
        )
    for row, bad in ((int(gaps.argmax()), LARGEST_GAP), (int(gaps.argmin()), SMALLEST_GAP)):
        ratio = gaps[row] / log.period
        if (ratio > bad) == (bad > 1.0) and ratio != bad:
            raise InvalidInputError(
                f"{log.name}, line {row + 3}: {gaps[row]:.4g} s since the row before, but the mean is "
                f"{log.period:.4g} s; give rows at even times, or the longest part without a gap"
            )


def _check_readings(log: Log) -> None:
    """Each quantity that the start of a simulation needs is measured all along; inputs are known always."""
    blank = np.isnan(log.inputs.values[:-1]).any(axis=1)
    if blank.any():
        line = int(np.flatnonzero(blank)[0]) + 2
        raise InvalidInputError(f"{log.name}, line {line}: a command is missing; give it in each row")
    for what, columns in (("u, v, w", log.velocity_body[:, :3]), ("attitude", log.quaternion_body_to_ned)):
        share = float(np.isnan(columns).any(axis=1).mean())
        if share > 0.9:
            raise InvalidInputError(
                f"{log.name}: {what} is missing in {100.0 * share:.3g} % of the rows; give a reading at least every "
                "tenth row"
            )


def _check_speed(log: Log, part: slice, limit: float, names: str, unit: str) -> None:
    speeds: NDArray[np.float64] = np.abs(np.nan_to_num(log.velocity_body[:, part])).max(axis=1)
    worst = int(speeds.argmax())
    if speeds[worst] > limit:
        raise InvalidInputError(
            f"{log.name}, line {worst + 2}: one of {names} = {speeds[worst]:.4g} {unit}, beyond {limit:g}; check the "
            "unit in the column's name"
        )
