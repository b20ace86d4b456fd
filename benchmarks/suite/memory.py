"""Section: memory, of what lies in arrays, of what a call takes, of the whole process."""

from __future__ import annotations

import gc
import sys
import tracemalloc
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import rounded
from suite.bodies import driven, full_scene, wrenches
from suite.child import said_by_child
from suite.environments import EPISODE, marine, random_actions
from suite.plan import Plan, Section
from suite.random_vehicles import coupled_vehicles, scattered_vehicles
from suite.tables import found, table

BODIES = 4096
DISTINCT_VEHICLES = 64
CALLS = 200
LEAD = EPISODE - CALLS // 2
"""Control periods before those that are watched, so that every episode has ended when they are over."""

RESIDENT, QUICK_RESIDENT = 65_536, 16_384
"""Environments in the process whose memory is looked at."""

PRECISIONS = ("float64", "float32")

METHOD = f"""\
**Held**: bytes of the arrays that a `Batch` and a vector environment keep for each body and each environment. Numbers
that are the same for all are stored once and are not counted. *Vehicles alike* are BlueROV2 Heavies, *of their own*
are random vehicles with the Heavy's terms, *coupled* are random vehicles with full matrices.

**Taken by calls**: what Python's allocator, with NumPy's arrays, has handed out after {CALLS} calls of `step` in excess
of before (*growth*), and at the peak of a call in excess of its beginning: for the middle call and for the hungriest,
which for environments is the one in which most episodes end. The measurement uses one thread, because what threads hand
each other is sometimes freed one call later, and empties Python's cache of attribute names before either count. With
`copy=False` the arrays are lent out instead of copied.

**Process**: growth of the resident memory of a process that makes {RESIDENT:,} environments and steps them, in excess
of that of the same process with 64, in bytes per environment.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return bytes."""
    held = [*bodies_held(plan), *environments_held(plan)]
    taken = [*taken_by_bodies(plan), *taken_by_environments(plan)]
    number = plan.pick(RESIDENT, QUICK_RESIDENT)
    plan.tell("compiling for a process of its own")
    said_by_child("suite.resident_memory", "64")  # or what compiling left free would be filled before it grew
    plan.tell(f"a process with {number:,} environments")
    resident = said_by_child("suite.resident_memory", str(number))
    return {"held": held, "taken": taken, "resident": resident | {"environments": number}}


def bodies_held(plan: Plan) -> Iterable[Row]:
    """Yield what a batch holds."""
    number = DISTINCT_VEHICLES
    scenes = {
        "alike": [full_scene()],
        "of their own": [full_scene(vehicle) for vehicle in scattered_vehicles(number)],
        "of their own, coupled": [full_scene(vehicle) for vehicle in coupled_vehicles(number)],
    }
    for vehicles, each in scenes.items():
        for precision in PRECISIONS:
            plan.tell(f"bodies, vehicles {vehicles}, {precision}")
            batch = driven(each, number, 1, "strict", precision)
            yield held("body", vehicles, precision, batch.bytes_per_body)
            batch.close()


def environments_held(plan: Plan) -> Iterable[Row]:
    """Yield what a vector environment holds."""
    number = DISTINCT_VEHICLES
    keywords: dict[str, dict[str, Any]] = {
        "alike": {},
        "of their own": {"vehicle": scattered_vehicles(number)},
        "of their own, coupled": {"vehicle": coupled_vehicles(number)},
    }
    for vehicles, given in keywords.items():
        for precision in PRECISIONS:
            plan.tell(f"environments, vehicles {vehicles}, {precision}")
            envs = marine(number, precision=precision, **given)
            yield held("environment", vehicles, precision, envs.unwrapped.bytes_per_environment)
            envs.close()


def held(what: str, vehicles: str, precision: str, number: float) -> Row:
    """Return a row."""
    return {"what": what, "vehicles": vehicles, "precision": precision, "bytes": rounded(number)}


def taken_by_bodies(plan: Plan) -> Iterable[Row]:
    """Yield what calls of a batch take."""
    plan.tell("calls of a batch")
    batch = driven([full_scene()], BODIES, 1, "strict")
    pushes = wrenches(BODIES)
    yield {"what": "`Batch.step`"} | traced(lambda _: batch.step(pushes), lead=10)
    batch.close()


def taken_by_environments(plan: Plan) -> Iterable[Row]:
    """Yield what calls of a vector environment take."""
    actions = random_actions((BODIES, 6))
    for copy in (True, False):
        plan.tell(f"calls of a vector environment, copy={copy}")
        envs = marine(BODIES, copy=copy, threads=1)
        envs.reset(seed=0)
        taken = traced(stepping(envs, actions), lead=LEAD)
        yield {"what": f"`make_vec(..., copy={copy}).step`"} | taken
        envs.close()


def stepping(envs: Any, actions: list[Any]) -> Callable[[int], Any]:
    """Return a function of a call's number."""
    return lambda call: envs.step(actions[call % len(actions)])


def traced(call: Callable[[int], Any], lead: int) -> Row:
    """Return what calls take of Python's allocator, after some that are not watched [bytes]."""
    peaks = np.zeros(CALLS, np.int64)
    tracemalloc.start()
    try:
        for number in range(lead):
            call(number)
        before = handed_out()
        for number in range(CALLS):
            peaks[number] = peak_of(call, lead + number)
        growth = handed_out() - before
    finally:
        tracemalloc.stop()
    return {
        "bodies": BODIES,
        "calls": CALLS,
        "growth": growth,
        "middle_peak": float(np.median(peaks)),
        "largest_peak": int(peaks.max()),
    }


def handed_out() -> int:
    """Return what is handed out and not garbage, without the names that Python's own cache keeps alive [bytes]."""
    clear: Callable[[], None] = getattr(sys, "_clear_internal_caches", None) or sys._clear_type_cache
    clear()
    gc.collect()
    return tracemalloc.get_traced_memory()[0]


def peak_of(call: Callable[[int], Any], number: int) -> int:
    """Return by how much a call takes more than it found, at its highest moment [bytes]."""
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    call(number)
    return tracemalloc.get_traced_memory()[1] - before


def tables(content: dict[str, Any]) -> str:
    """Return bytes held, taken, and resident."""
    return "\n".join(
        [
            "Bytes held:\n\n" + held_table(content["held"]),
            f"Bytes taken by calls, {BODIES:,} bodies or environments:\n\n" + taken_table(content["taken"]),
            resident_line(content["resident"]),
        ]
    )


def held_table(rows: list[Row]) -> str:
    """Return what each body and each environment holds."""
    lines = [
        [f"each {what}, vehicles {vehicles}"]
        + [
            three_digits(found(rows, what=what, vehicles=vehicles, precision=precision)["bytes"])
            for precision in PRECISIONS
        ]
        for what in distinct(rows, "what")
        for vehicles in distinct(rows, "vehicles")
    ]
    return table(["bytes", *PRECISIONS], lines)


def taken_table(rows: list[Row]) -> str:
    """Return what calls take."""
    lines = [
        [
            row["what"],
            f"{row['growth']:,}",
            f"{row['middle_peak']:,.0f}",
            three_digits(row["middle_peak"] / row["bodies"]),
            f"{row['largest_peak']:,}",
        ]
        for row in rows
    ]
    header = [
        "bytes",
        f"growth over {CALLS} calls",
        "peak of the middle call",
        "for each",
        "of the hungriest",
    ]
    return table(header, lines)


def resident_line(resident: Row) -> str:
    """Return what the process grew by."""
    each = per_environment(resident)
    return f"Process with {resident['environments']:,} environments: {each:,.0f} bytes an environment resident.\n"


def per_environment(resident: Row) -> float:
    """Return by how many bytes an environment the process grew."""
    return float((resident["after"] - resident["before"]) / resident["environments"])


def headline(content: dict[str, Any]) -> str:
    """Return bytes of a body and of an environment, and growth."""
    body, environment = (
        found(content["held"], what=what, vehicles="alike", precision="float64")["bytes"]
        for what in ("body", "environment")
    )
    growth = max(row["growth"] for row in content["taken"])
    return (
        f"{three_digits(body)} bytes a body, {three_digits(environment)} an environment held, "
        f"{per_environment(content['resident']):,.0f} resident; growth over {CALLS} calls at most "
        f"{growth:,} bytes"
    )


SECTION = Section("memory", "Memory", METHOD, measure, tables, headline)
