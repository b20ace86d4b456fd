"""Section: how long the first step takes, compiled anew or loaded from the cache."""

from __future__ import annotations

import tempfile
from typing import Any

from dq_marine.backend.disk_cache import CACHE_DIRECTORY_VARIABLE
from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import rounded
from suite.child import said_by_child
from suite.first_step import FIRST_STEPS, MANY
from suite.plan import Plan, Section
from suite.tables import table

COLD_ROUNDS, QUICK_COLD_ROUNDS = 2, 1
WARM_ROUNDS = 3
"""After each cold one."""

METHOD = f"""\
Seconds from `import dq_marine` in a fresh process to the end of the first reset and step. The rows are a single body
and {MANY} bodies in the full scene, a single environment, and {MANY} in a vector environment. *Cold* starts with an
empty `DQ_MARINE_CACHE_DIR`, so that everything is compiled; *warm* starts with the cache that the cold process left.
The import itself is part of both and imports no Numba. Python and the operating system have the files in memory.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of first steps."""
    rows: list[Row] = []
    rounds = plan.pick(COLD_ROUNDS, QUICK_COLD_ROUNDS)
    total = rounds * len(FIRST_STEPS)
    for done, (round_, name) in enumerate((r, n) for r in range(rounds) for n in FIRST_STEPS):
        plan.tell(f"{name}, round {round_ + 1} of {rounds}")
        plan.progress(done / total)
        rows += cold_and_warm(name)
    return {"rows": rows}


def cold_and_warm(name: str) -> list[Row]:
    """Return times of first steps of one thing, with an empty cache and then with the one left behind."""
    with tempfile.TemporaryDirectory(prefix="dq-marine-") as cache:
        rows = []
        for cache_state in ("cold", *["warm"] * WARM_ROUNDS):
            times = said_by_child("suite.first_step", name, **{CACHE_DIRECTORY_VARIABLE: cache})
            rows.append(
                {"what": name, "cache": cache_state} | {key: rounded(times[key]) for key in sorted(times)}
            )
    return rows


def tables(content: dict[str, Any]) -> str:
    """Return seconds, cold and warm."""
    rows = content["rows"]
    lines = [
        [name, *(three_digits(first_step(rows, name, state)) for state in ("cold", "warm"))]
        for name in distinct(rows, "what")
    ]
    imports = min(row["import_s"] for row in rows)
    note = f"Best of all rounds. `import dq_marine` is {three_digits(imports)} s of it.\n"
    return table(["seconds to the first step of", "cold", "warm"], lines) + "\n" + note


def first_step(rows: list[Row], name: str, state: str) -> float:
    """Return the shortest time to a first step, the import included [s]."""
    return min(
        row["import_s"] + row["first_s"] for row in rows if row["what"] == name and row["cache"] == state
    )


def headline(content: dict[str, Any]) -> str:
    """Return the times of all."""
    rows = content["rows"]
    shown = [
        f"{name} {three_digits(first_step(rows, name, 'cold'))} ({three_digits(first_step(rows, name, 'warm'))})"
        for name in distinct(rows, "what")
    ]
    return f"seconds to the first step, cold (warm): {', '.join(shown)}"


SECTION = Section("compile", "The first step", METHOD, measure, tables, headline)
