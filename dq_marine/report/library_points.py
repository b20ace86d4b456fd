"""Errors and times of libraries' integrators on a case, for the study of error against cost."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

import numpy as np

from dq_marine.report.cases import Case
from dq_marine.report.end_state import errors
from dq_marine.report.libraries import LIBRARIES, Library, LibraryRun
from dq_marine.report.plan import Row, Rows
from dq_marine.report.references import Reference, reference
from dq_marine.report.timing import no_garbage_collection, rounded
from dq_marine.report.trial import BLEW_UP, DONE, finite, overflow_allowed

TOLERANCES = tuple(10.0**-power for power in range(3, 14))
QUICK_TOLERANCES = TOLERANCES[:9:3]


def available(case: Case) -> list[Library]:
    """Return the libraries that are installed and can represent a case."""
    return [
        library
        for library in LIBRARIES.values()
        if installed(library.distribution) and not library.refusal(case)
    ]


def installed(distribution: str) -> bool:
    """Whether a package is there."""
    try:
        version(distribution)
    except PackageNotFoundError:
        return False
    return True


def settings_of(library: Library, case: Case, levels: tuple[int, ...], *, quick: bool) -> list[float]:
    """Return relative tolerances, or step sizes [s], from coarse to fine."""
    if library.setting == "rtol":
        return list(QUICK_TOLERANCES if quick else TOLERANCES)
    return [case.duration / steps for steps in levels]


@overflow_allowed
def library_rows(case: Case, library: Library, settings: list[float], samples: int, most: int) -> Rows:
    """Return errors and times of a library, up to a number of evaluations of the forces in a run."""
    exact = reference(case)
    rows: Rows = []
    for setting in settings:
        runs = [library.run(case, setting)]
        with no_garbage_collection():
            runs += [library.run(case, setting) for _ in range(samples)]
        rows.append(row_of(case, library, setting, runs, exact))
        if runs[0].evaluations > most:
            break
    return rows


def row_of(case: Case, library: Library, setting: float, runs: list[LibraryRun], exact: Reference) -> Row:
    """Return a library's errors and times with one setting."""
    samples = np.array([run.seconds for run in runs[1:]]) / case.duration
    lost = not np.isfinite(runs[0].end.velocity).all()
    row: Row = {
        "kind": "error",
        "case": case.name,
        "method": library.name,
        "setting": setting,
        "evaluations": runs[0].evaluations / case.duration,
        "outcome": BLEW_UP if lost else DONE,
        "known_to": max(exact.error),
        "best_ns": rounded(float(samples.min()) * 1e9),
        "median_ns": rounded(float(np.median(samples)) * 1e9),
    }
    if not lost:
        row |= {name: finite(value) for name, value in errors(runs[0].end, exact.end)._asdict().items()}
    return row
