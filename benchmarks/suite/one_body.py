"""Section: one body, what each term of its step costs."""

from __future__ import annotations

from typing import Any

from dq_marine.report.lean_scenes import STEP, terms_alone
from dq_marine.report.plan import distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from dq_marine.simulation.scene import Scene
from suite.plan import Plan, Section
from suite.tables import found, nanoseconds, noise, table

ORDERS = (2, 4)
STEPS = 5_000  # 100 s: a heavy body without damping does not fall fast yet
START = (0.3, 0.1, 0.05, 0.1, 0.2, 0.1)

METHOD = f"""\
A single BlueROV2 Heavy (`Scene(...).stepper()`) takes {STEPS:,} steps of {STEP} s in a call, from the same state each
time, on one core. The rows are inertia alone (the coupled 6x6 mass matrix), each term alone added to it, and
everything. A term that is absent is not computed. With net weight alone the body falls ever faster, so that its steps
take more iterations.
"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a step."""
    cases = {}
    for order in ORDERS:
        for name, arguments in terms_alone().items():
            plan.tell(f"order {order}, {name}")
            cases[order, name] = stepping(Scene(**arguments, step=STEP, order=order))
    plan.tell("all in turn")
    timings = plan.compare(cases)
    return {"rows": [{"order": key[0], "terms": key[1]} | timings[key].full_row() for key in cases]}


def stepping(scene: Scene) -> Timed:
    """Return the case of a body that starts from the same state in every call."""
    body = scene.stepper()
    body.reset(velocity_body=START)
    start = body.get_state()
    return Timed(lambda: body.step(steps=STEPS), STEPS, before=lambda: body.set_state(start))


def tables(content: dict[str, Any]) -> str:
    """Return terms against orders."""
    rows = content["rows"]
    lines = []
    for name in distinct(rows, "terms"):
        second, fourth = (found(rows, terms=name, order=order) for order in ORDERS)
        bare = found(rows, terms="inertia alone", order=2)
        lines.append(
            [
                name if name in ("inertia alone", "everything") else f"+ {name}",
                nanoseconds(second),
                nanoseconds(second, "median_ns"),
                three_digits(second["best_ns"] / bare["best_ns"]),
                nanoseconds(fourth),
                nanoseconds(fourth, "median_ns"),
                three_digits(fourth["best_ns"] / second["best_ns"]),
            ]
        )
    header = [
        "ns a step",
        "order 2",
        "(median)",
        "over inertia alone",
        "order 4",
        "(median)",
        "over order 2",
    ]
    return table(header, lines) + "\n" + noise(rows)


def headline(content: dict[str, Any]) -> str:
    """Return bare and full step."""
    bare, full = (found(content["rows"], terms=name, order=2) for name in ("inertia alone", "everything"))
    return f"{nanoseconds(bare)} ns a step bare, {nanoseconds(full)} ns with everything"


SECTION = Section("one_body", "One body", METHOD, measure, tables, headline)
