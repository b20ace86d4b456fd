"""Study: what becomes of free motions that are too fast, too stiff or too far away for a step."""

from __future__ import annotations

from functools import partial
from itertools import groupby
from typing import Any

import numpy as np

from dq_marine.report.branch import LONGEST_STRIDE, SCHEMES, confirmed_pieces
from dq_marine.report.cells import Cell, cells, summary
from dq_marine.report.end_state import end_of, errors
from dq_marine.report.methods import METHODS, UNSWEPT, Method
from dq_marine.report.plan import Plan, Row, Rows, Study, Unit
from dq_marine.report.showing.extreme_view import (
    ACCURATE,
    BOUNDED,
    FAILED,
    REFUSED,
    WRONG,
    checks,
    drawings,
    findings,
    tables,
)
from dq_marine.report.trial import BLEW_UP, DONE, Trial, finite, overflow_allowed, trial
from dq_marine.simulation.one_body import OneBody

STEPS = 50
ACCURATE_ERROR = 0.01
"""Largest relative error of what counts as accurate."""

KEPT_ENERGY = (0.5, 2.0)
"""Of the energy at the start: a free motion that leaves this range is no motion of the body."""

AGREEMENT = 1e-5
"""Difference of two methods at which they count as the exact motion."""

REFERENCE_METHODS = ("dqvi6", "rk4_quaternion")
REFINEMENTS = (4, 16, 64, 256, 1024)
CHECKED_STEPS = (0, 1, 2, 5, 10, 20, 49)

METHOD = f"""\
Free bodies with dense, coupled M, {STEPS} steps each, over all combinations of spin, speed, mass, condition number
of M, step size and distance from the origin, with directions drawn by a seed. *Accurate*: attitude within
{ACCURATE_ERROR:g} rad, velocity within {ACCURATE_ERROR:.0%} (in the norm of M) and position within
{ACCURATE_ERROR:.0%} of the way. The exact motion is where DQVI of order 6 and RK4, in ever smaller steps, agree to
{AGREEMENT:g}; where they do not agree within {REFINEMENTS[-1]} times smaller steps, nothing counts as accurate.
*Bounded*: not accurate, but with an energy between half and twice that at the start. *Wrong in silence*: a result,
without any complaint, whose energy is not. *Refused*: the method says by name that it cannot solve the step, and
changes nothing. *Blew up*: infinite or not a number. For the steps of DQVI of order 2 and of the paper, the
solution is also walked to from rest in at least {1.0 / LONGEST_STRIDE:.0f} strides, which tells a solution on
another branch."""


def units(plan: Plan) -> list[Unit]:
    """Return a unit a step size and speed."""
    refinements = plan.pick(REFINEMENTS, REFINEMENTS[:-1])
    methods = list(plan.pick(METHODS, UNSWEPT).values())

    def group(cell: Cell) -> tuple[float, float]:
        return cell.step, cell.levels["speed"]

    grouped = groupby(sorted(cells(plan), key=group), key=group)
    found = []
    for (step, speed), members in grouped:
        listed = list(members)
        found.append(
            Unit(
                f"step{step:g}-speed{speed:g}",
                partial(rows_of, listed, methods, refinements),
                summary(plan) | {"refinements": list(refinements), "methods": [one.name for one in methods]},
                weight=len(listed) * len(methods) * 0.014,
            )
        )
    return found


@overflow_allowed
def rows_of(members: list[Cell], methods: list[Method], refinements: tuple[int, ...]) -> Rows:
    """Return what becomes of some motions, by each method."""
    rows: Rows = []
    for cell in members:
        exact = exact_motion(cell, refinements)
        for method in methods:
            if not method.refusal(cell.physics):
                rows.append(row_of(cell, method, exact))
    return rows


def row_of(cell: Cell, method: Method, exact: OneBody | None) -> Row:
    """Return what becomes of a motion by a method."""
    body = started(cell, method, cell.step)
    energy = body.kinetic_energy
    history = [body.get_state()[1:]]
    outcome = DONE
    for _ in range(STEPS):
        outcome = body.attempt()
        if outcome != DONE:
            break
        history.append(body.get_state()[1:])
    ratio = body.kinetic_energy / energy
    error = difference(cell, body, exact) if exact is not None and outcome == DONE else np.inf
    row: Row = {
        **cell.levels,
        "cell": cell.index,
        "method": method.name,
        "outcome": named_outcome(outcome, ratio, error),
        "reason": "" if outcome in (DONE, BLEW_UP) else outcome,
        "has_reference": exact is not None,
        "error": finite(error),
        "energy_ratio": finite(ratio),
        "fallbacks": body.fallback_steps,
        "steps": body.steps_taken,
    }
    return row | branches(method, body, history)


def named_outcome(outcome: str, energy_ratio: float, error: float) -> str:
    """Return one of the outcomes that are counted."""
    if outcome == BLEW_UP or not np.isfinite(energy_ratio):
        return FAILED
    if outcome != DONE:
        return REFUSED
    if error <= ACCURATE_ERROR:
        return ACCURATE
    return BOUNDED if KEPT_ENERGY[0] <= energy_ratio <= KEPT_ENERGY[1] else WRONG


def branches(method: Method, body: Trial, history: list[Any]) -> Row:
    """Return how many of a motion's steps were looked at, and how many are on another branch than that from rest."""
    if method.name not in SCHEMES:
        return {}
    looked_at = [step for step in CHECKED_STEPS if step + 1 < len(history)]
    pieces = [
        confirmed_pieces(
            method.name, body.parameters.inertia, body.step_size, history[step], history[step + 1]
        )
        for step in looked_at
    ]
    return {
        "branch_steps": len(pieces),
        "branch_whole": pieces.count(1),
        "branch_split": sum(count > 1 for count in pieces),
        "branch_other": pieces.count(0),
    }


def exact_motion(cell: Cell, refinements: tuple[int, ...]) -> OneBody | None:
    """Return a body at the end of the exact motion; None where two methods do not come to agree."""
    for refinement in refinements:
        bodies = [refined(cell, METHODS[name], refinement) for name in REFERENCE_METHODS]
        one, other = bodies
        if one is not None and other is not None and difference(cell, one, other) <= AGREEMENT:
            return one
    return None


def refined(cell: Cell, method: Method, refinement: int) -> Trial | None:
    """Return a body at the end of a motion in smaller steps, None if it does not get there."""
    body = started(cell, method, cell.step / refinement)
    return body if body.attempt(steps=STEPS * refinement) == DONE else None


def started(cell: Cell, method: Method, step: float) -> Trial:
    """Return a body at the start of a motion."""
    body = trial(method, cell.physics, step)
    body.reset(cell.position, cell.quaternion, cell.velocity)
    return body


def difference(cell: Cell, body: OneBody, exact: OneBody) -> float:
    """Return the largest of the differences in attitude [rad], velocity and position, relative to their sizes."""
    apart = errors(end_of(body), end_of(exact))
    change = body.velocity_body - exact.velocity_body
    velocity = float(np.sqrt(change @ cell.physics.mass_matrix @ change / (2.0 * exact.kinetic_energy)))
    way = float(np.linalg.norm(exact.position_ned - cell.position)) + cell.levels["speed"] * STEPS * cell.step
    return max(apart.attitude, velocity, apart.position / way)


STUDY = Study("extreme", "Beyond all reason", METHOD, units, drawings, tables, findings, checks)
