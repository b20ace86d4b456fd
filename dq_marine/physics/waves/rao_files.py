"""Force transfer functions from files."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.checks import existing_file, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.rao import ForceRAO

AXES = ("X", "Y", "Z", "K", "M", "N")
"""Names of the axes in a CSV file, in Fossen's order."""

COLUMNS = ("frequency", "heading", "axis", "amplitude", "phase")
"""Columns of a CSV file."""

ENTRIES = ("frequencies", "headings", "real", "imaginary")
"""Entries of a JSON or NPZ file."""


def read_force_rao(path: str | os.PathLike[str]) -> ForceRAO:
    """Return the transfer functions of a file; see `ForceRAO` for their meaning.

    A .csv file has a line for each frequency [rad/s], heading [rad] and axis (X, Y, Z, K, M, N), with amplitude
    [N/m, N] and phase [rad, positive where the force leads]; axes without a line are zero. A .json or .npz file has
    `frequencies` (n,), `headings` (m,), and `real` and `imaginary`, each (n, m, 6).

    Raises:
        InvalidInputError: the file is not there, of another kind, or its numbers are wrong.
    """
    file = Path(path)
    readers = {".csv": _from_csv, ".json": _from_json, ".npz": _from_npz}
    if file.suffix not in readers:
        raise InvalidInputError(f"{file} is no {', '.join(readers)} file; give one of these")
    found = existing_file("path", file)
    if found is None:
        raise InvalidInputError(f"there is no file {shown(str(file))}")
    try:
        return readers[file.suffix](found)
    except Exception as error:  # a damaged archive fails with anything
        if isinstance(error, InvalidInputError):
            raise InvalidInputError(f"{file}: {error}") from error
        raise InvalidInputError(f"{file} cannot be read: {shown(error)}; give a whole file") from error


def _from_csv(file: Path) -> ForceRAO:
    with file.open(newline="", encoding="utf-8") as lines:
        rows = csv.DictReader(lines)
        missing = sorted(set(COLUMNS) - set(rows.fieldnames or ()))
        if missing:
            raise InvalidInputError(f"columns {missing} are missing; give {', '.join(COLUMNS)}")
        entries = {}
        for row in rows:
            if row["axis"] not in AXES:
                raise InvalidInputError(f"line {rows.line_num}: axis = {row['axis']!r}; give one of {AXES}")
            key = (float(row["frequency"]), float(row["heading"]), AXES.index(row["axis"]))
            entries[key] = float(row["amplitude"]) * np.exp(1j * float(row["phase"]))
    frequencies = np.array(sorted({key[0] for key in entries}))
    headings = np.array(sorted({key[1] for key in entries}))
    given = {key[:2] for key in entries}
    if len(given) != frequencies.size * headings.size:
        raise InvalidInputError(
            "a heading is missing at some frequency; give all headings at all frequencies"
        )
    transfer = np.zeros((frequencies.size, headings.size, 6), dtype=np.complex128)
    for (frequency, heading, axis), value in entries.items():
        transfer[np.searchsorted(frequencies, frequency), np.searchsorted(headings, heading), axis] = value
    return ForceRAO(frequencies, headings, transfer)


def _from_json(file: Path) -> ForceRAO:
    return _from_entries(json.loads(file.read_text(encoding="utf-8")))


def _from_npz(file: Path) -> ForceRAO:
    with np.load(file, allow_pickle=False) as arrays:
        return _from_entries({name: arrays[name] for name in arrays.files})


def _from_entries(entries: Any) -> ForceRAO:
    missing = sorted(set(ENTRIES) - set(entries))
    if missing:
        raise InvalidInputError(f"entries {missing} are missing; give {', '.join(ENTRIES)}")
    frequencies, headings, real, imaginary = (np.asarray(entries[name], dtype=np.float64) for name in ENTRIES)
    return ForceRAO(frequencies, headings, real + 1j * imaginary)
