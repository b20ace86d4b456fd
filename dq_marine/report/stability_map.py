"""Study: how large a step may be before damping or righting moments make a method fail."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from dq_marine.report.cases import CASES
from dq_marine.report.methods import METHODS, UNSWEPT, Method
from dq_marine.report.physics import Physics
from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.showing.stability_view import checks, drawings, findings, tables
from dq_marine.report.trial import BLEW_UP, DONE, trial

DAMPING, RESTORING, VEHICLE = "damping", "restoring", "vehicle"
MASS_MATRIX = np.diag([20.0, 25.0, 30.0, 1.0, 1.5, 2.0])
RATES = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5)
FREQUENCIES = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
FACTORS = (1.0, 10.0, 100.0, 1e3, 1e4)
LARGEST_STEP = 10.0
"""Beyond this no bound is looked for [s]."""

SMALLEST = {DAMPING: 0.02, RESTORING: 0.02, VEHICLE: 1e-3}
"""Smallest step that is tried, times the stiffness: h lambda, h omega, and h times the factor [s]."""

DAMPED_STEPS = 400
SWINGS = 1000
TILT = 1e-4
SMALL = 0.02
"""Largest tilt of a swing that is small still [rad]: near its limit a stable method enlarges it tens of times."""

GROWTH = 1.05
"""Of a swing's largest tilt, from one half of the run to the next: more is growth, less is a beat."""

BOUNDED = 10.0
"""Of the speeds that the vehicle in earnest reaches by the smallest step: more is failure."""

METHOD = f"""\
The largest step at which a motion stays bounded, by bisection. *Damping*: a body with D = lambda M from 1 m/s;
stable if after {DAMPED_STEPS} steps it is not faster than at the start. *Restoring*: a small roll under a righting
moment of frequency omega; stable if its tilt does not grow over {SWINGS} steps. *Vehicle*: a BlueROV2 Heavy under
thrust with its linear and quadratic damping times a factor. Steps up to {LARGEST_STEP:g} s are tried; and none
below h lambda or h omega = {SMALLEST[DAMPING]:g}."""


def units(plan: Plan) -> list[Unit]:
    """Return a unit a method and kind of stiffness."""
    picks = {
        DAMPING: plan.pick(RATES, RATES[::2]),
        RESTORING: plan.pick(FREQUENCIES, FREQUENCIES[::2]),
        VEHICLE: plan.pick(FACTORS, FACTORS[::2]),
    }
    halvings = plan.pick(14, 9)
    return [
        Unit(
            f"{kind}-{method.name}",
            partial(rows_of, kind, method, values, halvings),
            {"values": list(values), "halvings": halvings},
            weight=len(values) * halvings * (0.02 if kind == RESTORING else 0.004),
        )
        for kind, values in picks.items()
        for method in plan.pick(METHODS, UNSWEPT).values()
        if not method.refusal(PHYSICS[kind](values[0]))
    ]


def rows_of(kind: str, method: Method, values: tuple[float, ...], halvings: int) -> Rows:
    """Return the largest stable step of a method for each stiffness of a kind."""
    rows: Rows = []
    for value in values:
        physics = PHYSICS[kind](value)
        probe = partial(PROBES[kind], method, physics)
        stable, failing, how = largest_stable(probe, SMALLEST[kind] / value, halvings)
        rows.append(
            {
                "kind": kind,
                "method": method.name,
                "stiffness": value,
                "largest_step": stable,
                "failing_step": failing,
                "failure": how,
            }
        )
    return rows


def largest_stable(
    probe: Callable[[float], str], smallest: float, halvings: int
) -> tuple[float | None, float | None, str]:
    """Return the largest step that a probe finds stable, the smallest failing one found, and how that failed.

    No stable step: None first. No failing one up to `LARGEST_STEP`: None second.
    """
    how = probe(smallest)
    if how != DONE:
        return None, smallest, how
    ladder = np.geomspace(smallest, LARGEST_STEP, max(2, round(8 * np.log10(LARGEST_STEP / smallest))))
    stable = smallest
    for step in ladder[1:].tolist():
        how = probe(step)
        if how != DONE:
            return bisected(probe, stable, step, how, halvings)
        stable = step
    return stable, None, ""


def bisected(
    probe: Callable[[float], str], stable: float, failing: float, how: str, halvings: int
) -> tuple[float, float, str]:
    """Return the two steps brought together, and how the failing one fails."""
    for _ in range(halvings):
        middle = float(np.sqrt(stable * failing))
        outcome = probe(middle)
        if outcome == DONE:
            stable = middle
        else:
            failing, how = middle, outcome
    return stable, failing, how


def damped(rate: float) -> Physics:
    """Return a body with D = rate M."""
    return Physics(MASS_MATRIX, linear=rate * MASS_MATRIX)


def righted(frequency: float) -> Physics:
    """Return a body whose roll under its righting moment has a frequency [rad/s]."""
    return Physics(MASS_MATRIX, arm=np.array([0.0, 0.0, frequency**2 * MASS_MATRIX[3, 3]]))


def vehicle(factor: float) -> Physics:
    """Return a BlueROV2 Heavy with its damping times a factor."""
    own = CASES["damped_bluerov2"].physics
    return Physics(
        own.mass_matrix,
        own.excess_weight,
        own.arm,
        factor * own.linear,
        factor * own.quadratic,
        own.current_ned,
        own.forces,
    )


def probe_damping(method: Method, physics: Physics, step: float) -> str:
    """Return whether a body slows down, or how it fails."""
    body = trial(method, physics, step)
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    outcome = body.attempt(steps=DAMPED_STEPS)
    if outcome != DONE:
        return outcome
    return DONE if np.abs(body.velocity_body).max() <= 1.0 else BLEW_UP


def probe_restoring(method: Method, physics: Physics, step: float) -> str:
    """Return whether a swing keeps its size, or how it fails."""
    body = trial(method, physics, step)
    body.reset(quaternion_body_to_ned=(np.cos(0.5 * TILT), np.sin(0.5 * TILT), 0.0, 0.0))
    tilts = []
    for _ in range(SWINGS):
        outcome = body.attempt()
        if outcome != DONE:
            return outcome
        tilts.append(abs(float(body.quaternion_body_to_ned[1])))
    early, late = max(tilts[: SWINGS // 2]), max(tilts[SWINGS // 2 :])
    return DONE if late <= min(GROWTH * early, SMALL) else BLEW_UP


def probe_vehicle(method: Method, physics: Physics, step: float) -> str:
    """Return whether a vehicle under thrust stays as slow as damping keeps it, or how it fails."""
    case = CASES["damped_bluerov2"]
    body = trial(method, physics, step)
    case.place(body)
    fastest = max(float(np.abs(case.velocity).max()), 1.0)
    for _ in range(20):
        outcome = body.attempt(case.wrench, DAMPED_STEPS // 20)
        if outcome != DONE:
            return outcome
        if np.abs(body.velocity_body).max() > BOUNDED * fastest:
            return BLEW_UP
    return DONE


PHYSICS: dict[str, Callable[[float], Physics]] = {
    DAMPING: damped,
    RESTORING: righted,
    VEHICLE: vehicle,
}
PROBES: dict[str, Callable[[Method, Physics, float], str]] = {
    DAMPING: probe_damping,
    RESTORING: probe_restoring,
    VEHICLE: probe_vehicle,
}


STUDY = Study("stability_map", "How large a step may be", METHOD, units, drawings, tables, findings, checks)
