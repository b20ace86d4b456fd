"""Study: how exact each method is for its cost, on every case."""

from __future__ import annotations

from functools import partial
from typing import Any

from dq_marine.report.cases import CASES, Case
from dq_marine.report.end_state import end_of, errors
from dq_marine.report.library_points import available, library_rows, settings_of
from dq_marine.report.methods import METHODS, UNSWEPT, Method
from dq_marine.report.plan import Plan, Row, Rows, Study, Unit
from dq_marine.report.references import Reference, reference
from dq_marine.report.showing.work_precision_view import checks, drawings, findings, tables
from dq_marine.report.timing import Timed, compare
from dq_marine.report.trial import DONE, evaluations_of, finite, overflow_allowed, trial

COARSEST = 20
"""Steps of a whole motion."""

FULL_LEVELS = tuple(COARSEST * 2**level for level in range(15))
QUICK_LEVELS = FULL_LEVELS[:9]
SMALLEST_ERROR = 1e-12
"""Of attitude [rad]: a method that has come this far takes no smaller steps."""

LONGEST = 2_000_000
"""Evaluations of the forces in one run, at most."""

TIMED_STEPS = (2_000, 20_000)
"""Steps that a timing takes at the least, so that the call does not count, and at the most."""

LIBRARY_EVALUATIONS = (20_000, 3_000)
"""Of the forces in one run of a library; once there are more, no finer setting is tried. Full, quick."""

METHOD = f"""\
Each motion is run to its end with ever smaller steps, from {COARSEST} for the whole motion. Errors are those of
attitude, position and velocity at the end, against a closed form or the finest solution that is known. Time is that
of the compiled steps on one core, per simulated second: calls of {TIMED_STEPS[0]:,} steps or more, all methods and
sizes in turn, the shortest of several samples. Every method of this package and every baseline is compiled in the same
way and uses the same functions for the forces. Evaluations count how often all forces are evaluated; DQVI also
solves three equations for each of its drifts, which only the time shows. SciPy solves the same equations with the
same compiled forces and with tolerances instead of steps; its time is that of a whole solution, its own Python
included. MuJoCo can represent only the free rigid bodies exactly."""


def units(plan: Plan) -> list[Unit]:
    """Return errors by case and method, and times by case."""
    levels = plan.pick(FULL_LEVELS, QUICK_LEVELS)
    rounds = plan.pick(9, 3)
    found = []
    for case in CASES.values():
        if not plan.wants(case.name):
            continue
        known = plan.pick(METHODS, UNSWEPT)  # methods by sweeps take longest to compile
        methods = [method for method in known.values() if not method.refusal(case.physics)]
        settings: dict[str, Any] = case.summary() | {"levels": list(levels)}
        found += [
            Unit(
                f"{case.name}-{method.name}",
                partial(error_rows, case, method, levels),
                settings,
                weight=plan.pick(1.0, 0.2),
                group=case.name,
            )
            for method in methods
        ]
        names = [method.name for method in methods]
        found.append(
            Unit(
                f"{case.name}-times",
                partial(time_rows, case, methods, levels, rounds),
                settings | {"methods": names, "rounds": rounds},
                weight=plan.pick(1.5, 0.2) * len(methods),
                group=case.name,
            )
        )
        found += library_units(plan, case, levels)
    return found


def library_units(plan: Plan, case: Case, levels: tuple[int, ...]) -> list[Unit]:
    """Return errors and times of what is installed."""
    most, samples = plan.pick(*LIBRARY_EVALUATIONS), plan.pick(3, 1)
    found = []
    for library in available(case):
        values = settings_of(library, case, levels, quick=plan.quick)
        found.append(
            Unit(
                f"{case.name}-{library.name}",
                partial(library_rows, case, library, values, samples, most),
                case.summary() | {"values": values, "samples": samples, "most": most},
                weight=plan.pick(6.0, 0.6),
                group=case.name,
            )
        )
    return found


@overflow_allowed
def error_rows(case: Case, method: Method, levels: tuple[int, ...]) -> Rows:
    """Return the errors of a method, from the coarsest step until it cannot be better or it takes too long."""
    rows: Rows = []
    exact = reference(case)
    for steps in levels:
        if steps * evaluations_of(method, case.physics) > LONGEST:
            break
        row = error_row(case, method, steps, exact)
        rows.append(row)
        if row["outcome"] == DONE and (row["attitude"] or 1.0) < SMALLEST_ERROR:
            break
    return rows


def error_row(case: Case, method: Method, steps: int, exact: Reference) -> Row:
    """Return the errors of a method with one step size."""
    step = case.duration / steps
    body = trial(method, case.physics, step)
    case.place(body)
    outcome = body.attempt(case.wrench, steps)
    row: Row = {
        "kind": "error",
        "case": case.name,
        "method": method.name,
        "steps": steps,
        "step": step,
        "evaluations": evaluations_of(method, case.physics) / step,
        "outcome": outcome,
        "known_to": max(exact.error),
    }
    if outcome == DONE:
        found = errors(end_of(body), exact.end)
        row |= {name: finite(value) for name, value in found._asdict().items()}
    return row


def time_rows(case: Case, methods: list[Method], levels: tuple[int, ...], rounds: int) -> Rows:
    """Return times of all methods and step sizes, measured in turn."""
    cases: dict[tuple[str, int], Timed] = {}
    for method in methods:
        for steps in levels:
            timed = timed_steps(case, method, steps)
            if timed is not None:
                cases[method.name, steps] = timed
    timings = compare(cases, rounds)
    return [
        {"kind": "time", "case": case.name, "method": name, "steps": steps, **timings[name, steps].row()}
        for name, steps in cases
    ]


def timed_steps(case: Case, method: Method, steps: int) -> Timed | None:
    """Return the call whose time is taken, in nanoseconds a simulated second; None if the step fails."""
    step = case.duration / steps
    body = trial(method, case.physics, step)
    least, most = TIMED_STEPS
    for count in (min(max(steps, least), most), min(steps, most)):
        case.place(body)
        start = body.get_state()
        if body.attempt(case.wrench, count) == DONE:
            return Timed(partial(body.step, case.wrench, count), count * step, partial(body.set_state, start))
    return None


STUDY = Study("work_precision", "Error against cost", METHOD, units, drawings, tables, findings, checks)
