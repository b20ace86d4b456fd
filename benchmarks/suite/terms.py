"""Section: what each term of the scene costs a batch."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from dq_marine.engines.batch import Batch
from suite.bodies import check_all_went, terms_added_up
from suite.plan import Plan, Section
from suite.tables import digits, distinct, find, nanoseconds, noise, table
from suite.timing import Case, compare

BODIES = 4096
STEPS = 100
ARITHMETICS = ("strict", "fast")

METHOD = f"""\
`Scene.batch` of {BODIES:,} BlueROV2 Heavies on one thread in float64, {STEPS} steps in a call, coasting without a
wrench from the same random velocities in every call: inertia alone, then one term more in each row. Nanoseconds a step
of a body, and what the row's term adds to the row above. A negative number is no error: a term can make a motion
slower, so that steps take fewer iterations.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a body's step."""
    bodies = plan.pick(BODIES, 1024)
    velocities = np.random.default_rng(0).uniform(-0.3, 0.3, (bodies, 6))
    batches: dict[tuple[str, str], Batch] = {}
    cases = {}
    for name, scene in terms_added_up().items():
        for arithmetic in ARITHMETICS:
            plan.tell(f"{name}, {arithmetic}")
            batch = scene.batch(bodies, threads=1, arithmetic=arithmetic)
            batch.reset(velocity_body=velocities)
            batches[name, arithmetic] = batch
            cases[name, arithmetic] = coasting(batch)
    plan.tell("all in turn")
    timings = compare(cases, plan.rounds, plan.progress)
    for batch in batches.values():
        check_all_went(batch)
    return {
        "bodies": bodies,
        "rows": [{"terms": key[0], "arithmetic": key[1]} | timings[key].row() for key in cases],
    }


def coasting(batch: Batch) -> Case:
    """Return the case of a call that starts from the same state each time."""
    start = batch.get_state()
    return Case(lambda: batch.step(steps=STEPS), batch.size * STEPS, before=lambda: batch.set_state(start))


def tables(content: dict[str, Any]) -> str:
    """Return terms against arithmetics."""
    rows = content["rows"]
    names = distinct(rows, "terms")
    lines = [[name] for name in names]
    for arithmetic in ARITHMETICS:
        column = [find(rows, terms=name, arithmetic=arithmetic) for name in names]
        times = [row["best_ns"] for row in column if row]
        added = ["", *(digits(after - before) for before, after in pairwise(times))]
        for line, row, more in zip(lines, column, added, strict=True):
            line += [nanoseconds(row), more]
    header = ["ns a step", *(name for arithmetic in ARITHMETICS for name in (arithmetic, "adds"))]
    return table(header, lines) + "\n" + noise(rows)


def headline(content: dict[str, Any]) -> str:
    """Return the least and the most."""
    strict = [row for row in content["rows"] if row["arithmetic"] == "strict"]
    return (
        f"{nanoseconds(strict[0])} ns a step with inertia alone, {nanoseconds(strict[-1])} ns with all terms"
    )


SECTION = Section("terms", "The terms of a batch", METHOD, measure, tables, headline)
