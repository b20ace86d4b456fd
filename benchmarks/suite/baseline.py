"""Section: our batch against MuJoCo, measured in turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, get_args

import numpy as np
from mujoco_baseline import Array, Integrator, check
from mujoco_baseline import driven as driven_baseline

from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from dq_marine.simulation.batch import Batch
from dq_marine.vehicles import load_vehicle
from suite.batch import named
from suite.bodies import VEHICLE, check_all_went, driven, full_scene, wrenches
from suite.mujoco_rollout import MujocoRollout, rollout_exists
from suite.plan import NotInstalledError, Plan, Section
from suite.tables import found, millions, nanoseconds, noise, table

BODIES = 4096
QUICK_BODIES = 1024
STEPS = 20
"""In a call, of all."""

KINDS = (("strict", "float64"), ("fast", "float64"), ("fast", "float32"))
PACKED, ALONE = "packed", "one body a model"
LAYOUTS = {PACKED: None, ALONE: 1}
"""Bodies in a model, None for as many as are fastest."""

METHOD = f"""\
{BODIES:,} bodies have the BlueROV2 Heavy's size, mass, inertia and buoyancy, each under a different wrench of up to a
tenth of the limits. All take {STEPS} steps of 0.02 s in a call, and all are measured in the same rounds (A B C A B C
...). Ours is `Scene.batch` of the full scene: coupled added mass, net weight, righting moment, linear and quadratic
damping, current. MuJoCo (`benchmarks/mujoco_baseline.py`) has free bodies in its ellipsoid fluid model, in float64,
with net weight, righting moment and the held wrench. Contacts and everything else that is not needed are switched off,
and the free joint is at the centre of buoyancy. MuJoCo runs through its `batch` and through its `rollout`, in the usual
layout (*{ALONE}*), and *{PACKED}* to be as fast as possible: many bodies in one model share the fixed cost of a call of
`mj_step`.

Some things do not compare. MuJoCo's fluid knows the Coriolis forces of the added mass but not its inertia, it has no
current here, and during a call a held force keeps its direction in the world instead of in the body; all three are in
its favour. A `rollout` writes every state on the way, and the others do not. Euler and implicitfast are of first order,
ours is of second, RK4 of fourth, so equal steps do not give equal accuracy.
"""


@dataclass(frozen=True)
class Contender:
    """Bodies under way, to be advanced.

    Attributes:
        row: what tells it apart.
        bodies: how many.
        advance: by `STEPS` steps.
        finish: end its threads; raise RuntimeError if its speed says nothing, for bodies stand or blew up.
    """

    row: Row
    bodies: int
    advance: Callable[[], None]
    finish: Callable[[], None]


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a body's step."""
    vehicle = load_vehicle(VEHICLE)
    try:
        for integrator in get_args(Integrator):
            plan.tell(f"checking the motion by {integrator}")
            check(vehicle, integrator)
    except ImportError as error:
        raise NotInstalledError(str(error)) from error
    bodies = plan.pick(BODIES, QUICK_BODIES)
    contenders = [one for threads in plan.threads for one in contenders_with(plan, bodies, threads)]
    plan.tell(f"{len(contenders)} contenders in turn")
    cases = {key: Timed(one.advance, one.bodies * STEPS) for key, one in enumerate(contenders)}
    timings = plan.compare(cases)
    for one in contenders:
        one.finish()
    return {
        "bodies": bodies,
        "rollout": rollout_exists(),
        "rows": [one.row | timings[key].full_row() for key, one in enumerate(contenders)],
    }


def contenders_with(plan: Plan, bodies: int, threads: int) -> list[Contender]:
    """Return all that advance bodies with a number of threads."""
    contenders = []
    for arithmetic, precision in KINDS:
        plan.tell(f"dq-marine, {arithmetic} {precision}, {named(threads)}")
        contenders.append(ours(bodies, threads, arithmetic, precision))
    for integrator in get_args(Integrator):
        for layout in LAYOUTS:
            plan.tell(f"MuJoCo, {integrator}, {layout}, {named(threads)}")
            contenders += theirs(bodies, threads, integrator, layout)
    return contenders


def ours(bodies: int, threads: int, arithmetic: str, precision: str) -> Contender:
    """Return a batch of the full scene."""
    batch = driven([full_scene()], bodies, threads, arithmetic, precision)
    pushes = wrenches(bodies)
    row = {"who": "dq-marine", "kind": f"{arithmetic} {precision}", "threads": threads}
    return Contender(row, bodies, lambda: batch.step(pushes, steps=STEPS), partial(finish_batch, batch))


def theirs(bodies: int, threads: int, integrator: Integrator, layout: str) -> list[Contender]:
    """Return MuJoCo's ways to advance one layout."""
    vehicle = load_vehicle(VEHICLE)
    baseline = driven_baseline(vehicle, bodies, threads, integrator, LAYOUTS[layout])
    row = {
        "who": "MuJoCo",
        "integrator": integrator,
        "layout": layout,
        "bodies_per_model": baseline.bodies_per_model,
        "threads": threads,
    }
    contenders = [
        Contender(
            row | {"kind": f"{integrator}, {layout}", "way": "batch"},
            bodies,
            lambda: baseline.advance(STEPS),
            lambda: check_finite(integrator, baseline.velocities),
        )
    ]
    if rollout_exists():
        rollout = MujocoRollout(baseline, threads, STEPS)
        contenders.append(
            Contender(
                row | {"kind": f"{integrator}, {layout}, rollout", "way": "rollout"},
                bodies,
                rollout.advance,
                partial(finish_rollout, rollout, integrator),
            )
        )
    return contenders


def finish_batch(batch: Batch) -> None:
    """End our threads, if all bodies moved."""
    check_all_went(batch)
    batch.close()


def finish_rollout(rollout: MujocoRollout, integrator: str) -> None:
    """End MuJoCo's threads, if all bodies moved sensibly."""
    check_finite(integrator, rollout.velocities)
    rollout.close()


def check_finite(integrator: str, velocities: Array) -> None:
    """Raise RuntimeError if MuJoCo's bodies blew up."""
    if not np.isfinite(velocities).all():
        raise RuntimeError(f"MuJoCo's {integrator} blew up, so that its speed says nothing")


def tables(content: dict[str, Any]) -> str:
    """Return the times of all, and ours against theirs."""
    rows = content["rows"]
    parts = [
        f"{content['bodies']:,} bodies:\n\n" + times(rows),
        "Our speed over MuJoCo's:\n\n" + ratios(rows),
    ]
    if not content["rollout"]:
        parts.append("The installed MuJoCo has no `mujoco.rollout`.\n")
    return "\n".join([*parts, noise(rows)])


def times(rows: list[Row]) -> str:
    """Return everybody's time and rate."""
    threads = distinct(rows, "threads")
    lines = []
    for kind in distinct(rows, "kind"):
        cells = [found(rows, kind=kind, threads=count) for count in threads]
        numbers = [words for cell in cells for words in (nanoseconds(cell), millions(cell))]
        lines.append([f"{cells[0]['who']}, {kind}", *numbers])
    header = [words for count in threads for words in (f"{named(count)}: ns a step", "million a second")]
    return table(["", *header], lines)


def ratios(rows: list[Row]) -> str:
    """Return how many times faster ours are than each of theirs, with as many threads."""
    columns = [(count, " ".join(kind)) for count in distinct(rows, "threads") for kind in KINDS]
    lines = []
    for kind in distinct([row for row in rows if row["who"] == "MuJoCo"], "kind"):
        cells = [
            found(rows, kind=kind, threads=count)["best_ns"] / found(rows, kind=own, threads=count)["best_ns"]
            for count, own in columns
        ]
        lines.append([kind, *(three_digits(cell) for cell in cells)])
    return table(["over", *(f"{own}, {named(count)}" for count, own in columns)], lines)


def headline(content: dict[str, Any]) -> str:
    """Return how many times faster strict and fast are than MuJoCo at its fastest, packed and in the usual layout."""
    most = max(distinct(content["rows"], "threads"))
    rows = [row for row in content["rows"] if row["threads"] == most]
    parts = []
    for layout in LAYOUTS:
        best = min((row for row in rows if row.get("layout") == layout), key=lambda row: row["best_ns"])
        times = [
            three_digits(best["best_ns"] / found(rows, kind=f"{arithmetic} float64")["best_ns"])
            for arithmetic in ("strict", "fast")
        ]
        parts.append(f"strict {times[0]}, fast {times[1]} times as fast as MuJoCo ({best['kind']})")
    return f"{content['bodies']:,} bodies, {named(most)}: {'; '.join(parts)}"


SECTION = Section("mujoco", "Against MuJoCo", METHOD, measure, tables, headline)
