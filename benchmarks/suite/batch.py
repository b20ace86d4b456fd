"""Section: many bodies, by size, threads, arithmetic and precision."""

from __future__ import annotations

from itertools import product
from typing import Any

from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed, rounded
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import Scene
from suite.bodies import check_all_went, driven, full_scene, wrenches
from suite.plan import Plan, Section
from suite.random_vehicles import scattered_vehicles
from suite.tables import find, millions, noise, table

SIZES = tuple(4**k for k in range(9))
QUICK_SIZES = (1, 64, 4096)
KINDS = (("strict", "float64"), ("fast", "float64"), ("strict", "float32"), ("fast", "float32"))
OWN_KINDS = KINDS[:2]
CALLS = (100, 1)
"""Steps in a call."""

DISTINCT_VEHICLES = 256
SHOWN_SIZE = 4096

Key = tuple[str, int, str, str, int]

METHOD = f"""\
`Scene.batch` of BlueROV2 Heavies with every term that the scene can have: net weight, righting moment, linear and
quadratic damping, a current, and a different wrench for each body. The figures are million steps of a body per second,
with 100 steps in a call and with one. A call checks and copies the wrenches, which is part of the time. *strict* has
the bits of a single body; *fast* fuses multiply-adds and reorders sums. A cell is empty where there are fewer blocks of
bodies than threads.

The last table is for `batch_of` with {DISTINCT_VEHICLES} random vehicles, dealt out over the bodies. All of their
numbers differ and are loaded for each body.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a body's step."""
    rows: list[Row] = []
    fleet = [full_scene(vehicle) for vehicle in scattered_vehicles(DISTINCT_VEHICLES)]
    for size in plan.pick(SIZES, QUICK_SIZES):
        rows += rows_of_size(plan, size, fleet)
    return {"rows": rows}


def rows_of_size(plan: Plan, size: int, fleet: list[Scene]) -> list[Row]:
    """Return all kinds of batches of one size, measured in turn."""
    scenes = {"alike": [full_scene()], "own": (fleet * (size // len(fleet) + 1))[:size]}
    batches: dict[Key, Batch] = {}
    cases: dict[Key, Timed] = {}
    for vehicles, threads in product(scenes, plan.threads):
        for arithmetic, precision in KINDS if vehicles == "alike" else OWN_KINDS:
            plan.tell(f"{size:,} bodies, {arithmetic} {precision}, vehicles {vehicles}")
            batch = driven(scenes[vehicles], size, threads, arithmetic, precision)
            for steps in CALLS if vehicles == "alike" else CALLS[:1]:
                key = (vehicles, threads, arithmetic, precision, steps)
                batches[key], cases[key] = batch, stepping(batch, steps)
    plan.tell(f"{size:,} bodies, all in turn")
    timings = plan.compare(cases)
    for batch in batches.values():
        check_all_went(batch)
        batch.close()
    return [
        dict(zip(("vehicles", "threads", "arithmetic", "precision", "steps"), key, strict=True))
        | {"bodies": size, "threads_used": batch.threads, "bytes_per_body": rounded(batch.bytes_per_body)}
        | {"fallback_steps": batch.fallback_steps}
        | timings[key].full_row()
        for key, batch in batches.items()
    ]


def stepping(batch: Batch, steps: int) -> Timed:
    """Return the case of a call."""
    pushes = wrenches(batch.size)
    return Timed(lambda: batch.step(pushes, steps=steps), batch.size * steps)


def tables(content: dict[str, Any]) -> str:
    """Return rates by size, their scaling, and vehicles of their own."""
    rows = content["rows"]
    parts = [
        f"Million steps a second, {steps} {'steps' if steps > 1 else 'step'} in a call:\n\n"
        + rates(rows, KINDS, vehicles="alike", steps=steps)
        for steps in CALLS
    ]
    if len(distinct(rows, "threads")) > 1:
        most = named(max(distinct(rows, "threads")))
        parts.append(f"Times faster with {most} than with one, 100 steps in a call:\n\n" + scaling(rows))
    own = rates(rows, OWN_KINDS, vehicles="own", steps=CALLS[0])
    parts.append("Million steps a second, each body a vehicle of its own, 100 steps in a call:\n\n" + own)
    return "\n".join([*parts, noise(rows)])


def rates(rows: list[Row], kinds: tuple[tuple[str, str], ...], **wanted: Any) -> str:
    """Return sizes against kinds and threads."""
    columns = list(product(kinds, distinct(rows, "threads")))
    lines = []
    for size in distinct(rows, "bodies"):
        cells = [
            find(rows, bodies=size, arithmetic=kind[0], precision=kind[1], threads=threads, **wanted)
            for kind, threads in columns
        ]
        lines.append([f"{size:,}", *(millions(cell if is_real(cell) else None) for cell in cells)])
    header = ["bodies", *(f"{' '.join(kind)}, {named(threads)}" for kind, threads in columns)]
    return table(header, lines)


def scaling(rows: list[Row]) -> str:
    """Return what more threads bring."""
    lines = []
    for size in distinct(rows, "bodies"):
        cells = [gain(rows, size, kind) for kind in KINDS]
        if any(cells):
            lines.append([f"{size:,}", *cells])
    return table(["bodies", *(" ".join(kind) for kind in KINDS)], lines)


def gain(rows: list[Row], size: int, kind: tuple[str, str]) -> str:
    """Return how many times faster the most threads are than one, nothing where there were not as many."""
    wanted = {
        "bodies": size,
        "arithmetic": kind[0],
        "precision": kind[1],
        "vehicles": "alike",
        "steps": CALLS[0],
    }
    threads = distinct(rows, "threads")
    one, most = (find(rows, threads=count, **wanted) for count in (min(threads), max(threads)))
    return three_digits(one["best_ns"] / most["best_ns"]) if one and most and is_real(most) else ""


def is_real(row: Row | None) -> bool:
    """Whether a row was measured with as many threads as it was meant for."""
    return row is not None and row["threads"] == row["threads_used"]


def named(threads: int) -> str:
    """Return a number of threads in words."""
    return "1 thread" if threads == 1 else f"{threads} threads"


def headline(content: dict[str, Any]) -> str:
    """Return the rates of a batch of the usual size."""
    rows = content["rows"]
    most = max(distinct(rows, "threads"))
    wanted = {"bodies": SHOWN_SIZE, "threads": most, "vehicles": "alike", "steps": CALLS[0]}
    rates = [
        f"{arithmetic} {precision} {millions(find(rows, arithmetic=arithmetic, precision=precision, **wanted))}"
        for arithmetic, precision in KINDS
    ]
    return f"million steps/s, {SHOWN_SIZE:,} bodies, {named(most)}: {', '.join(rates)}"


SECTION = Section("batch", "Many bodies", METHOD, measure, tables, headline)
