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
from dq_marine.report.timing import Timed, Timing, compare
from dq_marine.report.trial import DONE, evaluations_of, finite, overflow_allowed, trial

COARSEST = 5
"""Steps of a whole motion: methods of order 8 follow most motions with so few."""

CLOSE = 160
"""Steps up to which each number is the square root of two times the one before, later twice: among the coarsest, where
sweeps only just converge, neither error nor time follows a straight line."""

FULL_LEVELS = (
    *(round(COARSEST * 2 ** (level / 2)) for level in range(10)),
    *(CLOSE * 2**level for level in range(12)),
)
QUICK_LEVELS = FULL_LEVELS[:16]
SMALLEST_ERROR = 1e-12
"""Of attitude [rad]: a method that has come this far takes no smaller steps."""

LONGEST = 2_000_000
"""Evaluations of the forces in one run, at most."""

TIMED_STEPS = (2_000, 20_000)
"""Steps from which on the call itself does not count in a timing, and steps that one takes at the most."""

LIBRARY_EVALUATIONS = (20_000, 3_000)
"""Of the forces in one run of a library; once there are more, no finer setting is tried. Full, quick."""

METHOD = f"""\
Each motion is run to its end with ever smaller steps, from {COARSEST} for the whole motion. Errors are those of
attitude, position and velocity at the end, against a closed form or the finest solution that is known. Time is that
of the compiled steps on one core, per simulated second of the motion itself, all methods and sizes in turn, the
shortest of several samples; where a motion has fewer than {TIMED_STEPS[0]:,} steps, less the time of a call of one.
Every method of this package and every baseline is compiled in the same way and uses the same functions for the forces.
Evaluations count how often all forces are evaluated; DQVI also solves three equations for each of its drifts, which
only the time shows. SciPy solves the same equations with the same compiled forces and with tolerances instead of
steps; its time is that of a whole solution, its own Python included. MuJoCo can represent only the free rigid bodies
exactly."""


def units(plan: Plan) -> list[Unit]:
    """Return errors by case and method, and times by case."""
    levels = plan.pick(FULL_LEVELS, QUICK_LEVELS)
    rounds = plan.pick(9, 3)
    found = []
    for case in CASES.values():
        if not plan.wants(case.name):
            continue
        known = plan.pick(METHODS, UNSWEPT)
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
    calls = {
        (method.name, steps, count): timed
        for method in methods
        for steps in levels
        for count, timed in timed_calls(case, method, steps).items()
    }
    timings = compare(calls, rounds)
    rows: Rows = []
    for name, steps, count in calls:
        if count > 1:
            call, first = timings[name, steps, count], timings.get((name, steps, 1))
            step = case.duration / steps
            row: Row = {"kind": "time", "case": case.name, "method": name, "steps": steps}
            rows.append(row | seconds_each(call, first, count).per(step).row())
    return rows


def seconds_each(call: Timing, first: Timing | None, count: int) -> Timing:
    """Return the time of a step, from that of a call of `count` and, if the call itself counts, of one of one."""
    if first is None or first.best >= call.best:
        return call.per(count)
    least = call.best - first.best  # whatever the slower samples, which tell of the machine, come to
    pairs = zip(sorted(call.samples), sorted(first.samples), strict=True)
    return Timing(tuple(max(least, many - one) for many, one in pairs), call.cores).per(count - 1)


def timed_calls(case: Case, method: Method, steps: int) -> dict[int, Timed]:
    """Return the calls whose times tell that of a step, by their number of steps; none if the step fails."""
    body = trial(method, case.physics, case.duration / steps)
    enough, most = TIMED_STEPS
    count = min(steps, most)
    case.place(body)
    start = body.get_state()
    if body.attempt(case.wrench, count) != DONE:
        return {}
    body.set_state(start)
    found = {}
    for each in (count,) if count >= enough else (1, count):
        put_back, advance = body.bare_calls(case.wrench, each)
        found[each] = Timed(advance, 1.0, put_back)
    return found


STUDY = Study("work_precision", "Error against cost", METHOD, units, drawings, tables, findings, checks)
