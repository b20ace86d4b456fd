"""Study: energy and momentum over a million steps of motions that should keep them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.cases import CASES, Case
from dq_marine.report.invariants import energy, momentum_errors
from dq_marine.report.methods import METHODS, UNSWEPT, Method
from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.showing.long_run_view import checks, drawings, findings, tables
from dq_marine.report.trial import DONE, evaluations_of, finite, overflow_allowed, trial
from dq_marine.vehicles import load_vehicle

FREE = "kirchhoff_bluerov2"
RIGHTED = "kirchhoff_bluerov2_righted"
STEPS = (0.02, 0.1)
SAMPLES_A_DECADE = 24

METHOD = """\
A BlueROV2 Heavy without damping, once with no force at all (Kirchhoff's equations), once with its righting moment,
in runs of a million steps (a hundred thousand with --quick). Energy is kinetic and potential, its error relative to
the kinetic energy at the start. Momentum is that of body and water in the world, its error relative to its size at
the start; with the righting moment the linear one and the angular one about the vertical are constant."""


def long_cases() -> dict[str, Case]:
    """Return what is run, by name."""
    free = CASES[FREE]
    arm = load_vehicle("bluerov2_heavy").restoring_arm
    righted = replace(
        free,
        name=RIGHTED,
        title=f"{free.title}, with righting moment",
        physics=replace(free.physics, arm=arm),
        exact=None,
    )
    return {FREE: free, RIGHTED: righted}


def units(plan: Plan) -> list[Unit]:
    """Return a unit a case, method and step size."""
    total = plan.pick(1_000_000, 100_000)
    return [
        Unit(
            f"{name}-{method.name}-{step:g}",
            partial(run, case, method, step, total),
            case.summary() | {"step": step, "total": total},
            weight=total * evaluations_of(method, case.physics) * 4e-7,
        )
        for name, case in long_cases().items()
        for method in plan.pick(METHODS, UNSWEPT).values()
        if not method.refusal(case.physics)
        for step in STEPS
    ]


@overflow_allowed
def run(case: Case, method: Method, step: float, total: int) -> Rows:
    """Return energy and momentum errors at times that lie evenly on a logarithmic axis."""
    body = trial(method, case.physics, step)
    case.place(body)
    start, kinetic = energy(case.physics, body), body.kinetic_energy
    momentum = body.spatial_momentum
    common: dict[str, Any] = {"case": case.name, "title": case.title, "method": method.name, "step": step}
    rows: Rows = []
    for count in np.diff(sampled_steps(total), prepend=0).tolist():
        outcome = body.attempt(case.wrench, count)
        taken = body.steps_taken if outcome == DONE else body.steps_taken + count
        row = common | {"steps": taken, "time": taken * step, "outcome": outcome}
        if outcome != DONE:
            return [*rows, row]
        linear, angular = momentum_errors(case.physics, momentum, body.spatial_momentum)
        row["energy_error"] = finite((energy(case.physics, body) - start) / kinetic)
        row["linear_momentum_error"], row["angular_momentum_error"] = finite(linear), finite(angular)
        rows.append(row)
    return rows


def sampled_steps(total: int) -> NDArray[np.int64]:
    """Return counts of steps from 1 to all, evenly spaced in their logarithm."""
    count = int(SAMPLES_A_DECADE * np.log10(total)) + 1
    return np.unique(np.rint(np.geomspace(1, total, count)).astype(np.int64))


STUDY = Study("long_run", "A million steps", METHOD, units, drawings, tables, findings, checks)
