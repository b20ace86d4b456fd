"""Study: what each term of a scene costs, for one body and for many."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.report.lean_scenes import NOTHING, STEP, VEHICLE, scenes
from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.showing.terms_view import drawings, findings, tables
from dq_marine.report.timing import Timed, compare
from dq_marine.simulation.scene import Scene

START = (0.3, 0.1, 0.05, 0.1, 0.2, 0.1)
ONE_BODY_STEPS = 5_000
BATCH_STEPS = 100
BODIES = 4096
FEW_BODIES = 512
LONG_SAMPLE = 0.02
"""Shortest time that a sample is taken over [s]."""

METHOD = f"""\
A BlueROV2 Heavy at h = {STEP:g} s, from the same velocities each time, without a wrench: with nothing but its
coupled 6x6 inertia, with each term alone on top of it, and with everything. One body in calls of {ONE_BODY_STEPS:,}
steps; a batch on one core in calls of {BATCH_STEPS} steps, strict double precision, time a step of one body. A term
that is absent is not in the compiled step. A term also changes the motion, and with it how many Newton iterations a
step takes: those stand beside the times."""


def units(plan: Plan) -> list[Unit]:
    """Return what is measured: one body, and many."""
    bodies = plan.pick(BODIES, FEW_BODIES)
    rounds = plan.pick(15, 5)
    settings: dict[str, Any] = {"vehicle": VEHICLE, "rounds": rounds, "seed": plan.seed}
    return [
        Unit("one_body", lambda: one_body_rows(rounds), settings, weight=plan.pick(8.0, 3.0)),
        Unit(
            "batch",
            lambda: batch_rows(bodies, rounds, plan.seed),
            settings | {"bodies": bodies},
            weight=plan.pick(12.0, 5.0),
        ),
    ]


def one_body_rows(rounds: int) -> Rows:
    """Return times of a step of one body."""
    bodies = {name: scene.stepper() for name, scene in scenes().items()}
    cases = {}
    for name, body in bodies.items():
        body.reset(velocity_body=START)
        start = body.get_state()
        cases[name] = Timed(
            lambda body=body: body.step(steps=ONE_BODY_STEPS),  # type: ignore[misc]
            ONE_BODY_STEPS,
            before=lambda body=body, start=start: body.set_state(start),  # type: ignore[misc]
        )
    timings = compare(cases, rounds, least=LONG_SAMPLE)
    return [
        {
            "backend": "one body",
            "terms": name,
            "iterations": body.newton_iterations / body.steps_taken,
            **timings[name].row(),
        }
        for name, body in bodies.items()
    ]


def batch_rows(size: int, rounds: int, seed: int) -> Rows:
    """Return times of a step of a body in a batch."""
    velocities = np.random.default_rng(seed).uniform(-0.3, 0.3, (size, 6))
    cases = {name: coasting(scene, velocities) for name, scene in scenes().items()}
    timings = compare(cases, rounds, least=LONG_SAMPLE)
    return [{"backend": "batch", "terms": name, "bodies": size, **timings[name].row()} for name in cases]


def coasting(scene: Scene, velocities: Any) -> Timed:
    """Return the call of a batch that starts from the same state each time."""
    batch = scene.batch(len(velocities), threads=1)
    batch.reset(velocity_body=velocities)
    start = batch.get_state()
    return Timed(
        lambda: batch.step(steps=BATCH_STEPS),
        len(velocities) * BATCH_STEPS,
        before=lambda: batch.set_state(start),
    )


STUDY = Study(
    "terms", "What each term costs", METHOD, units, drawings, tables, lambda rows: findings(rows, NOTHING)
)
