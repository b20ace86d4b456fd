"""Section: what the catalogue's vehicles and the water around them cost."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.physics.current.build import CurrentProfile
from dq_marine.physics.weather import Jonswap, Sea, SlowDrift, Wind
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import vehicle_names
from suite.bodies import CURRENT, STEP, VEHICLE, check_all_went
from suite.plan import Plan, Section
from suite.tables import found, nanoseconds, noise, table

STEPS = 500
BODIES = 1024
PROFILE = CurrentProfile(depths=(0.0, 10.0, 50.0), velocities=((0.5, 0.1), (0.3, 0.0), (0.0, 0.0)))
SEA = Sea(Jonswap(height=0.5, period=5.0), direction=0.7, seed=1)

METHOD = f"""\
Each vehicle of the catalogue has every term of its file and is pushed at a tenth of its limits, {STEPS} steps of
{STEP} s in a call: a single body, and a body of a batch of {BODIES:,} on one thread (strict, float64). Then one term at
a time is added to a BlueROV2 Heavy and to an Otter. A term that is not in a scene is not computed and costs nothing.
The sea has {SEA.components} components.
"""


def scenes() -> dict[str, dict[str, Any]]:
    """Return the arguments of scenes by name."""
    vehicles = {name: {"vehicle": name} for name in vehicle_names()}
    more: dict[str, dict[str, Any]] = {
        "current": {"current": CURRENT},
        "current by depth": {"current": PROFILE},
        "thrusters": {"actuation": "thrusters"},
        "sea": {"weather": [SEA]},
    }
    floating = {
        "wind with gusts": {"weather": [Wind(6.0, direction_from=3.8, gusts=True)]},
        "sea and slow drift": {"weather": [SEA, SlowDrift(SEA)]},
        "hull": {"hydrostatics": "hull"},
    }
    rov = {f"{VEHICLE} + {name}": {"vehicle": VEHICLE, **arguments} for name, arguments in more.items()}
    boat = {
        f"otter + {name}": {"vehicle": "otter", **arguments}
        for name, arguments in {**more, **floating}.items()
    }
    return {**vehicles, **rov, **boat}


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a body's step."""
    bodies = plan.pick(BODIES, 128)
    cases, batches = {}, []
    for name, arguments in scenes().items():
        plan.tell(name)
        scene = Scene(**arguments, step=STEP)
        cases[name, 1] = single(scene)
        batch = scene.batch(bodies, threads=1)
        batches.append(batch)
        cases[name, bodies] = many(scene, batch)
    plan.tell("all in turn")
    timings = plan.compare(cases)
    for batch in batches:
        check_all_went(batch)
    return {
        "bodies": bodies,
        "rows": [{"scene": key[0], "bodies": key[1]} | timings[key].full_row() for key in cases],
    }


def push(scene: Scene) -> Any:
    """Return a tenth of the limits: a wrench, or commands of actuators."""
    if scene.actuation == "wrench":
        return 0.1 * scene.vehicle.wrench_limits
    return 0.1 * np.array([channel.high for channel in scene.vehicle.channels])


def single(scene: Scene) -> Timed:
    """Return the case of one body that starts from the same state in every call."""
    body, wanted = scene.stepper(), push(scene)
    move = body.step if scene.actuation == "wrench" else body.actuate
    start = body.get_state()
    return Timed(lambda: move(wanted, steps=STEPS), STEPS, before=lambda: body.set_state(start))


def many(scene: Scene, batch: Batch) -> Timed:
    """Return the case of bodies that start from the same state in every call."""
    steps, wanted = STEPS // 10, push(scene)
    move = batch.step if scene.actuation == "wrench" else batch.actuate
    start = batch.get_state()
    return Timed(lambda: move(wanted, steps=steps), batch.size * steps, before=lambda: batch.set_state(start))


def tables(content: dict[str, Any]) -> str:
    """Return scenes against the two backends."""
    rows = content["rows"]
    lines = []
    for name in dict.fromkeys(row["scene"] for row in rows):
        one = found(rows, scene=name, bodies=1)
        lane = found(rows, scene=name, bodies=content["bodies"])
        lines.append(
            [name, nanoseconds(one), nanoseconds(lane), three_digits(one["best_ns"] / lane["best_ns"])]
        )
    return table(["ns a step", "one body", "a body of a batch", "ratio"], lines) + "\n" + noise(rows)


def headline(content: dict[str, Any]) -> str:
    """Return the ROV's and the boat's."""
    rows = content["rows"]
    rov, boat = (found(rows, scene=name, bodies=1) for name in (VEHICLE, "otter"))
    return f"one body: {VEHICLE} {nanoseconds(rov)} ns a step, otter {nanoseconds(boat)} ns"


SECTION = Section("water", "Vehicles and water", METHOD, measure, tables, headline)
