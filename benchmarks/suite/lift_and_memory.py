"""Section: what the lift of the ROVs and the memory of radiated waves cost."""

from __future__ import annotations

import tempfile
from typing import Any

from dq_marine.backend.disk_cache import CACHE_DIRECTORY_VARIABLE
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import rounded
from dq_marine.simulation.scene import Scene
from suite.bodies import STEP, check_all_went
from suite.child import said_by_child
from suite.first_step import PAIRED_STEPS, paired_scene
from suite.plan import Plan, Section
from suite.tables import found, nanoseconds, noise, table
from suite.water import BODIES, STEPS, many, single

PAIRS = {"lift": "BlueROV2 Heavy, lift", "memory": "supply vessel, radiation memory"}
"""What is added, and to what."""

COLD_ROUNDS = 2

METHOD = f"""\
The BlueROV2 Heavy as its file has it, and without the eight couplings of its lift; the supply vessel with radiation
memory, 24 states more, and without. Each is pushed at a tenth of its limits, {STEPS} steps of {STEP} s in a call: a
single body, and a body of a batch of {BODIES:,} on one thread (strict, float64). First steps are of a single body or a
batch in a fresh process, from `import dq_marine` on, with an empty `DQ_MARINE_CACHE_DIR`, so that everything is
compiled; with memory, its model is identified, too.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a body's step and of first steps."""
    bodies = plan.pick(BODIES, 128)
    cases, batches = {}, []
    for pair in PAIRS:
        for has in (False, True):
            plan.tell(f"{pair}: {'with' if has else 'without'}")
            scene: Scene = paired_scene(pair, has=has)
            batch = scene.batch(bodies, threads=1)
            batches.append(batch)
            cases[pair, has, 1] = single(scene)
            cases[pair, has, bodies] = many(scene, batch)
    plan.tell("all in turn")
    timings = plan.compare(cases)
    for batch in batches:
        check_all_went(batch)
    rows = [{"pair": key[0], "has": key[1], "bodies": key[2]} | timings[key].full_row() for key in cases]
    return {"bodies": bodies, "rows": rows, "first": first_steps(plan)}


def first_steps(plan: Plan) -> dict[str, float]:
    """Return the shortest time to a first step with an empty cache, by name [s]."""
    best: dict[str, float] = {}
    for _ in range(plan.pick(COLD_ROUNDS, 1)):
        for name in PAIRED_STEPS:
            plan.tell(f"first step of {name}")
            with tempfile.TemporaryDirectory(prefix="dq-marine-") as cache:
                times = said_by_child("suite.first_step", name, **{CACHE_DIRECTORY_VARIABLE: cache})
            best[name] = min(best.get(name, float("inf")), rounded(sum(times.values())))
    return best


def tables(content: dict[str, Any]) -> str:
    """Return step times and first steps, with and without."""
    lines = [
        [f"{title}: {what}", *values]
        for pair, title in PAIRS.items()
        for what, values in _lines(content, pair)
    ]
    header = ["", "without", "with", "ratio"]
    return table(header, lines) + "\n" + noise(content["rows"])


def _lines(content: dict[str, Any], pair: str) -> list[tuple[str, list[str]]]:
    lines = []
    for name, bodies in (("one body", 1), ("a body of a batch", content["bodies"])):
        off, on = (found(content["rows"], pair=pair, has=has, bodies=bodies) for has in (False, True))
        ratio = three_digits(on["best_ns"] / off["best_ns"])
        lines.append((f"{name}, ns a step", [nanoseconds(off), nanoseconds(on), ratio]))
    for name in ("one body", "batch"):
        off_s, on_s = (content["first"][f"{pair} {which} {name}"] for which in ("without", "with"))
        lines.append((f"first step, {name}, s", [*map(three_digits, (off_s, on_s, on_s / off_s))]))
    return lines


def headline(content: dict[str, Any]) -> str:
    """Return the ratios of one body and of a batch."""
    ratios = {pair: [values[2] for _, values in _lines(content, pair)[:2]] for pair in PAIRS}
    parts = [
        f"{pair} {one} times a step of one body, {lane} in a batch" for pair, (one, lane) in ratios.items()
    ]
    return "; ".join(parts)


SECTION = Section("lift_memory", "Lift and radiation memory", METHOD, measure, tables, headline)
