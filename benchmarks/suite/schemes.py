"""Section: what an environment could do in a control period, by scheme, order and substeps."""

from __future__ import annotations

import statistics
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from dq_marine.report.plan import Row
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.one_body import OneBody
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import vehicle_names
from suite.bodies import CURRENT, VEHICLE
from suite.plan import Plan, Section
from suite.tables import found, noise, table
from suite.water import SEA

Array = NDArray[np.float64]

PERIOD = 0.1
PERIODS = 100
LANES = 1024
HELD = 20
"""Periods for which an action is held where one body is timed."""

FINE = 40
"""Substeps of the reference, of order 4."""


class Way(NamedTuple):
    """A way through a control period."""

    scheme: str
    order: int
    substeps: int

    @property
    def label(self) -> str:
        """For a column."""
        steps = "1 step" if self.substeps == 1 else f"{self.substeps} steps"
        return f"{self.scheme} {self.order}, {steps}"

    def scene(self, arguments: dict[str, Any]) -> Scene:
        """Return the scene that goes this way."""
        return Scene(**arguments, step=PERIOD / self.substeps, scheme=self.scheme, order=self.order)


HEADER = (
    *("m, median", "m, worst", "deg, median", "deg, worst", "fallback"),
    *("ns, one body", "ns, lanes", "over default", "lanes over default"),
)

DEFAULT = Way("midpoint", 2, 4)
WAYS = (
    DEFAULT,
    Way("midpoint", 2, 1),
    Way("midpoint", 4, 1),
    Way("galerkin", 4, 1),
    Way("galerkin", 8, 1),
    Way("gauss", 8, 1),
    Way("runge_kutta", 4, 1),
    Way("runge_kutta", 8, 1),
)
REFERENCE = Way("midpoint", 4, FINE)

METHOD = f"""\
An environment takes a control period of {PERIOD} s in steps, by default in {DEFAULT.substeps} of order 2. Here
one body with every term of its file, in a current, is driven for {PERIODS} periods by actions that are drawn
anew for each, uniform to the limits, the hardest that an agent does. *Error* is what one period adds: the way
and the turn between its end and that of {FINE} steps of order 4 from the same state, in the median and in the
worst period. *Fallback* is the share of steps that the method did not solve itself. *ns* is what a period of
the first action costs from rest: one body, held for {HELD} periods in a call, and one of {LANES:,} in lanes on
one thread (strict, float64).
"""


def cases(plan: Plan) -> dict[str, dict[str, Any]]:
    """Return arguments of scenes by name."""
    names = plan.pick(vehicle_names(), [VEHICLE])
    more: dict[str, dict[str, Any]] = {
        f"{VEHICLE} by its thrusters": {"vehicle": VEHICLE, "actuation": "thrusters"},
        "otter in a sea": {"vehicle": "otter", "weather": [SEA]},
    }
    plain = {name: {"vehicle": name, "current": CURRENT} for name in names}
    return {**plain, **plan.pick(more, {})}


def measure(plan: Plan) -> dict[str, Any]:
    """Return errors, fallback steps and times of each way."""
    lanes = plan.pick(LANES, 64)
    rows, timed = [], {}
    for name, arguments in cases(plan).items():
        plan.tell(f"{name}: reference")
        actions, states = flown(REFERENCE.scene(arguments))
        for way in WAYS:
            plan.tell(f"{name}: {way.label}")
            scene = way.scene(arguments)
            body = scene.stepper()
            rows.append({"case": name, "way": way.label} | errors(body, scene, actions, states, way.substeps))
            timed[name, way.label, 1] = repeated(body, scene, actions[0], states[0])
            batch = scene.batch(lanes, threads=1)
            timed[name, way.label, lanes] = repeated(batch, scene, actions[0], np.tile(states[0], (lanes, 1)))
    plan.tell("all in turn")
    timings = plan.compare(timed)
    for row in rows:
        for label, bodies in (("one", 1), ("lane", lanes)):
            row[label] = timings[row["case"], row["way"], bodies].full_row()
    return {"lanes": lanes, "rows": rows}


def flown(scene: Scene) -> tuple[Array, Array]:
    """Return actions, and the states before and after each: those of the reference."""
    actions, body = drawn_actions(scene), scene.stepper()
    states = [body.get_state()]
    for action in actions:
        drive(body, scene, action)
        states.append(body.get_state())
    return actions, np.array(states)


def drawn_actions(scene: Scene) -> Array:
    """Return an action for each period, up to the limits, the same for every way."""
    rng = np.random.default_rng(0)
    if scene.actuation == "wrench":
        limits = scene.vehicle.wrench_limits
        return np.asarray(limits * rng.uniform(-1.0, 1.0, (PERIODS, limits.size)))
    low, high = np.array([(channel.low, channel.high) for channel in scene.vehicle.channels]).T
    return np.asarray(rng.uniform(low, high, (PERIODS, low.size)))


def drive(moved: OneBody | Batch, scene: Scene, action: Array, periods: int = 1) -> None:
    """Hold an action."""
    move = moved.step if scene.actuation == "wrench" else moved.actuate
    move(action, steps=periods * round(PERIOD / scene.step))


def errors(body: OneBody, scene: Scene, actions: Array, states: Array, substeps: int) -> dict[str, Any]:
    """Return how far one period of this way ends from the reference, each from the reference's own state."""
    ways, turns = [], []
    for action, before, after in zip(actions, states[:-1], states[1:], strict=True):
        body.set_state(before)
        drive(body, scene, action)
        position, attitude = body.position_ned, body.quaternion_body_to_ned
        body.set_state(after)
        ways.append(float(np.linalg.norm(position - body.position_ned)))
        apart = Rotation.from_quat(attitude, scalar_first=True).inv() * Rotation.from_quat(
            body.quaternion_body_to_ned, scalar_first=True
        )
        turns.append(float(np.degrees(apart.magnitude())))
    return {
        "way_m": [statistics.median(ways), max(ways)],
        "turn_deg": [statistics.median(turns), max(turns)],
        "fallback": body.fallback_steps / (PERIODS * substeps),
    }


def repeated(moved: OneBody | Batch, scene: Scene, action: Array, start: Array) -> Timed:
    """Return the case of one action, held for periods enough to make the call itself cheap, from the same state."""
    bodies, periods = (moved.size, 1) if isinstance(moved, Batch) else (1, HELD)

    def call() -> None:
        drive(moved, scene, action, periods)

    return Timed(call, periods * bodies, before=lambda: moved.set_state(start))


def tables(content: dict[str, Any]) -> str:
    """Return a table for each case."""
    parts = []
    for name in dict.fromkeys(row["case"] for row in content["rows"]):
        base = found(content["rows"], case=name, way=DEFAULT.label)
        lines = [line(row, base) for row in content["rows"] if row["case"] == name]
        parts.append(table([name, *HEADER], lines))
    timings = [row[key] for row in content["rows"] for key in ("one", "lane")]
    return "\n".join(parts) + "\n" + noise(timings)


def line(row: Row, base: Row) -> list[str]:
    """Return a way's line, beside the default's."""
    errors_of = [f"{value:.1e}" for value in (*row["way_m"], *row["turn_deg"])]
    times = [row[key]["best_ns"] for key in ("one", "lane")]
    ratios = [row[key]["best_ns"] / base[key]["best_ns"] for key in ("one", "lane")]
    return [row["way"], *errors_of, f"{row['fallback']:.1%}", *map(three_digits, times + ratios)]


def headline(content: dict[str, Any]) -> str:
    """Return what the highest order costs and gains, for the usual vehicle."""
    rows = content["rows"]
    base = found(rows, case=VEHICLE, way=DEFAULT.label)
    best = found(rows, case=VEHICLE, way=Way("galerkin", 8, 1).label)
    ratio = three_digits(best["one"]["best_ns"] / base["one"]["best_ns"])
    return (
        f"a period of {VEHICLE}: galerkin 8 in one step takes {ratio} times what the default takes, and errs by "
        f"{best['way_m'][0]:.1e} m instead of {base['way_m'][0]:.1e} m"
    )


SECTION = Section("schemes", "A control period, by scheme", METHOD, measure, tables, headline)
