"""Section: what each term of the scene costs a batch."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from dq_marine.report.plan import distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from dq_marine.simulation.batch import Batch
from suite.bodies import check_all_went, terms_added_up
from suite.plan import Plan, Section
from suite.tables import find, nanoseconds, noise, table

BODIES = 4096
STEPS = 100
ARITHMETICS = ("strict", "fast")

METHOD = f"""\
`Scene.batch` of {BODIES:,} BlueROV2 Heavies on one thread in float64, {STEPS} steps in a call. The bodies coast without
a wrench from the same random velocities in every call. The first row has inertia alone, and each row adds one term. The
figures are nanoseconds per step of a body, and what the row's term adds to the row above. A negative number is not a
mistake: a term can slow a motion down, so that its steps take fewer iterations.
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
    timings = plan.compare(cases)
    for batch in batches.values():
        check_all_went(batch)
    return {
        "bodies": bodies,
        "rows": [{"terms": key[0], "arithmetic": key[1]} | timings[key].full_row() for key in cases],
    }


def coasting(batch: Batch) -> Timed:
    """Return the case of a call that starts from the same state each time."""
    start = batch.get_state()
    return Timed(lambda: batch.step(steps=STEPS), batch.size * STEPS, before=lambda: batch.set_state(start))


def tables(content: dict[str, Any]) -> str:
    """Return terms against arithmetics."""
    rows = content["rows"]
    names = distinct(rows, "terms")
    lines = [[name] for name in names]
    for arithmetic in ARITHMETICS:
        column = [find(rows, terms=name, arithmetic=arithmetic) for name in names]
        times = [row["best_ns"] for row in column if row]
        added = ["", *(three_digits(after - before) for before, after in pairwise(times))]
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
