"""Section: error against run time for bodies in lanes, beside RK4 in the same lanes."""

from __future__ import annotations

import statistics
from itertools import count
from typing import Any

from dq_marine.report.cases import CASES, Case
from dq_marine.report.end_state import end_of, errors
from dq_marine.report.methods import METHODS, Method
from dq_marine.report.plan import Row
from dq_marine.report.presentation import three_digits
from dq_marine.report.references import reference
from dq_marine.report.showing.fits import cost_at
from dq_marine.report.timing import Timed
from dq_marine.report.trial import DONE, overflow_allowed, trial
from dq_marine.simulation.batch import Batch
from suite.plan import Plan, Section
from suite.tables import noise, table

RIVAL = "rk4_quaternion"
OWN = ("gauss6", "gauss8", "rk4", "rk8")
STRONGER = "dop853"
TARGETS = (1e-2, 1e-4, 1e-6)
"""Errors of attitude at the end [rad]."""

LANES = 1024
COARSEST = 5
"""Steps of a motion; from there on each finer one has the square root of two times as many."""

MOST_STEPS = 100
"""Of a call."""

LARGEST, TOO_EXACT = 0.3, 3e-7
"""Errors between which points are measured [rad]; the first one below is the last."""

METHOD = f"""\
All undamped motions of `dq-marine report`, by RK4 and DOP853 on quaternions, by Gauss's collocation (`scheme="gauss"`,
orders 6 and 8) and by `scheme="runge_kutta"`, orders 4 and 8, each compiled in the same way for bodies in lanes
(`Batch`, {LANES:,} equal bodies, strict, float64, one thread). Every method takes {COARSEST}, 7, 10, 14, ... steps for
the motion. The time for an error is read off between points, as the report does it: that of a body's step in calls of
up to {MOST_STEPS} steps from the start, times the number of steps. Given is that time over RK4's for the same error in
attitude at the end, first for each method, then for the best of them, and last the best one's over DOP853's.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return errors and times of all step sizes."""
    cases = [case for case in CASES.values() if case.conservative]
    lanes = plan.pick(LANES, 64)
    rows: list[Row] = []
    for case in plan.pick(cases, cases[:2]):
        points = [row for name in (RIVAL, STRONGER, *OWN) for row in points_of(plan, case, METHODS[name])]
        plan.tell(f"{case.name}, all in turn")
        timings = plan.compare({(row["method"], row["steps"]): stepping(case, row, lanes) for row in points})
        rows += [row | timings[row["method"], row["steps"]].full_row() for row in points]
    return {"lanes": lanes, "rows": rows}


@overflow_allowed
def points_of(plan: Plan, case: Case, method: Method) -> list[Row]:
    """Return the errors of a method by its number of steps, those of a single body: lanes have the same bits."""
    plan.tell(f"{case.name}, {method.title}")
    exact, rows = reference(case).end, []
    for level in count():
        steps = round(COARSEST * 2.0 ** (level / 2))
        body = trial(method, case.physics, case.duration / steps)
        case.place(body)
        if body.attempt(case.wrench, steps) != DONE:
            continue
        error = errors(end_of(body), exact).attitude
        if error <= LARGEST:
            rows.append({"case": case.name, "method": method.name, "steps": steps, "attitude": error})
        if error < TOO_EXACT:
            return rows
    raise AssertionError("a method comes as near as one likes")


def stepping(case: Case, row: Row, lanes: int) -> Timed:
    """Return the case of bodies that begin a motion anew in every call."""
    composition, parameters_at = METHODS[row["method"]].compose(case.physics)
    h = case.duration / row["steps"]
    batch = Batch(composition, [parameters_at(h)] * lanes, h, lanes, threads=1)
    batch.reset(case.position, case.quaternion, case.velocity)
    start, steps = batch.get_state(), min(row["steps"], MOST_STEPS)
    return Timed(
        lambda: batch.step(case.wrench, steps=steps),
        lanes * steps,
        before=lambda: batch.set_state(start),
    )


def ratios(content: dict[str, Any], case: str) -> dict[str, list[float]]:
    """Return the times over RK4's for each target, by method, for the best as "best", and over DOP853's as "rest"."""
    costs = {
        name: [cost_of(content, case, name, target) for target in TARGETS] for name in (RIVAL, STRONGER, *OWN)
    }
    best = [min(own) for own in zip(*(costs[name] for name in OWN), strict=True)]
    return {
        **{name: over(costs[name], costs[RIVAL]) for name in OWN},
        "best": over(best, costs[RIVAL]),
        "rest": over(best, costs[STRONGER]),
    }


def over(own: list[float], other: list[float]) -> list[float]:
    """Return ratios."""
    return [a / b for a, b in zip(own, other, strict=True)]


def cost_of(content: dict[str, Any], case: str, method: str, target: float) -> float:
    """Return a body's time for an error [ns]; infinite if it is not reached."""
    rows = [row for row in content["rows"] if row["case"] == case and row["method"] == method]
    cost = cost_at([row["best_ns"] * row["steps"] for row in rows], [row["attitude"] for row in rows], target)
    return float("inf") if cost is None else cost


def means(content: dict[str, Any]) -> dict[str, list[float]]:
    """Return the means of all cases."""
    found = [ratios(content, case) for case in cases_of(content)]
    return {
        name: [statistics.mean(column) for column in zip(*(each[name] for each in found), strict=True)]
        for name in (*OWN, "best", "rest")
    }


def cases_of(content: dict[str, Any]) -> list[str]:
    """Return the names of the motions that were measured."""
    return list(dict.fromkeys(row["case"] for row in content["rows"]))


def tables(content: dict[str, Any]) -> str:
    """Return the ratios of each motion, and their means."""
    titles = {
        "gauss6": "Gauss 6",
        "gauss8": "Gauss 8",
        "rk4": "Runge-Kutta 4",
        "rk8": "Runge-Kutta 8",
        "best": "the best",
        "rest": "the best over DOP853's",
    }
    header = [
        "time over RK4's",
        *(f"{title}, {target:.0e}" for title in titles.values() for target in TARGETS),
    ]
    found = {CASES[case].title: ratios(content, case) for case in cases_of(content)}
    lines = [
        [name, *(three_digits(value) for method in titles for value in each[method])]
        for name, each in {**found, "mean": means(content)}.items()
    ]
    return table(header, lines) + "\n" + noise(content["rows"])


def headline(content: dict[str, Any]) -> str:
    """Return the means of the better of both."""
    found = means(content)
    best, rest = (
        ", ".join(
            f"{three_digits(value)} at {target:.0e}"
            for value, target in zip(found[name], TARGETS, strict=True)
        )
        for name in ("best", "rest")
    )
    return f"the best of ours takes RK4's time in the same lanes times {best}; DOP853's times {rest}"


SECTION = Section("lanes_against_rk4", "Error against run time in lanes", METHOD, measure, tables, headline)
