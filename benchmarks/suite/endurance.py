"""Section: a long time with random vehicles and random actions; does every number stay finite?"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.kept import Kept
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import batch_of
from dq_marine.vehicles import load_vehicle
from suite import circumstances
from suite.batch import named
from suite.bodies import STEP, VEHICLE, full_scene
from suite.plan import Plan, Section
from suite.random_vehicles import coupled_vehicles
from suite.tables import table

BODIES = 1000
MINUTES, QUICK_MINUTES = 24 * 60, 10
HELD_STEPS = 50
"""Steps for which an action is held."""

ACTIONS_A_MINUTE = round(60.0 / (STEP * HELD_STEPS))
CHECKPOINT_MINUTES = 10

METHOD = f"""\
{BODIES:,} random vehicles fly in one `batch_of`, in strict float64 arithmetic. Mass, inertia, added mass and damping
are scattered by up to 40 %; their matrices are full, symmetric positive definite, and couple every axis to every
other; the centres are off the axes; there are net weights, net buoyancies and a current. Actions are random over the
whole range of the actuators and are drawn anew every {STEP * HELD_STEPS:g} s for every axis of every body. Steps of
{STEP} s make {MINUTES // 60} hours of simulated time. Every state is checked after each simulated minute. Steps are
*solved by the fallback* where plain Newton did not solve them; a call is *refused* if a body did not take part in it.
The sea has no bottom and no shore: bodies that sink, rise or drift with the current do so all day.
"""


@dataclass
class Tally:
    """What has happened so far.

    Attributes:
        minutes: simulated.
        seconds: that they took.
        fallbacks: steps that plain Newton did not solve.
        refused: calls that a body did not take part in.
        reasons: why, with the number of calls.
        not_finite: bodies with a number that is not finite, at the last look.
        fastest: largest speed over ground seen [m/s].
        fastest_spin: largest angular velocity seen [rad/s].
        farthest: largest distance from the start seen [m].
        attitude_error: largest deviation of a quaternion's length from 1 seen.
    """

    minutes: int = 0
    seconds: float = 0.0
    fallbacks: int = 0
    refused: int = 0
    reasons: dict[str, int] = field(default_factory=dict)
    not_finite: int = 0
    fastest: float = 0.0
    fastest_spin: float = 0.0
    farthest: float = 0.0
    attitude_error: float = 0.0

    def look_at(self, batch: Batch) -> None:
        """Take note of all bodies' states."""
        self.fallbacks, self.refused = batch.fallback_steps, batch.steps_refused
        velocity, attitude = batch.velocity_body, batch.quaternion_body_to_ned
        self.not_finite = int(np.count_nonzero(~np.isfinite(batch.get_state()).all(axis=1)))
        self.fastest = max(self.fastest, length(velocity[:, :3]))
        self.fastest_spin = max(self.fastest_spin, length(velocity[:, 3:]))
        self.farthest = max(self.farthest, length(batch.position_ned))
        error = np.abs(np.linalg.norm(attitude, axis=1) - 1.0).max()
        self.attitude_error = max(self.attitude_error, float(error))

    def note_refusals(self, batch: Batch) -> None:
        """Take note of why bodies did not take part in the last call."""
        for reason in batch.refusals.values():
            self.reasons[reason] = self.reasons.get(reason, 0) + 1


def measure(plan: Plan) -> dict[str, Any]:
    """Return what happened."""
    minutes = plan.pick(MINUTES, QUICK_MINUTES)
    plan.tell(f"{BODIES:,} random vehicles")
    scenes = [full_scene(vehicle) for vehicle in coupled_vehicles(BODIES)]
    batch = batch_of(scenes, threads=plan.threads[-1])
    checkpoint = Kept(plan.scratch / f"endurance-{minutes}.json", circumstances.source_fingerprint())
    tally = taken_up(batch, checkpoint)
    plan.tell(f"{minutes:,} simulated minutes")
    while tally.minutes < minutes:
        plan.progress(tally.minutes / minutes)
        simulate_a_minute(batch, tally)
        if tally.minutes % CHECKPOINT_MINUTES == 0:
            checkpoint.write({"tally": asdict(tally), "state": batch.get_state().tolist()})
    checkpoint.remove()
    batch.close()
    return {"bodies": BODIES, "threads": batch.threads} | asdict(tally)


def taken_up(batch: Batch, checkpoint: Kept) -> Tally:
    """Return a new tally, or that of the checkpoint, to whose state the batch is then set."""
    kept = checkpoint.read()
    if kept is None:
        batch.step()  # compiles
        batch.reset()
        return Tally()
    tally = Tally(**kept["tally"])
    batch.set_state(kept["state"])
    batch.fallback_steps, batch.steps_refused = tally.fallbacks, tally.refused
    return tally


def simulate_a_minute(batch: Batch, tally: Tally) -> None:
    """Push all bodies for a minute, with actions that follow from its number."""
    start = time.perf_counter()
    shares = np.random.default_rng(tally.minutes).uniform(-1.0, 1.0, (ACTIONS_A_MINUTE, BODIES, 6))
    for wrenches in shares * load_vehicle(VEHICLE).wrench_limits:
        refused = batch.steps_refused
        batch.step(wrenches, steps=HELD_STEPS)
        if batch.steps_refused > refused:
            tally.note_refusals(batch)
    tally.seconds += time.perf_counter() - start
    tally.minutes += 1
    tally.look_at(batch)


def length(vectors: NDArray[np.float64]) -> float:
    """Return the length of the longest of some vectors."""
    return float(np.linalg.norm(vectors, axis=1).max())


def body_steps(content: dict[str, Any]) -> int:
    """Return how many steps all bodies took together, refused calls left out."""
    calls = content["minutes"] * ACTIONS_A_MINUTE * content["bodies"] - content["refused"]
    return int(calls * HELD_STEPS)


def tables(content: dict[str, Any]) -> str:
    """Return what happened."""
    reasons = ", ".join(f"{count:,} {reason}" for reason, count in content["reasons"].items())
    lines = [
        ["bodies", f"{content['bodies']:,}"],
        ["simulated time of each", f"{content['minutes'] / 60.0:.4g} h"],
        ["steps, all bodies together", f"{body_steps(content):,}"],
        ["steps by the fallback", f"{content['fallbacks']:,}"],
        ["calls refused", f"{content['refused']:,}" + (f" ({reasons})" if reasons else "")],
        ["bodies with a NaN or an infinity at the end", f"{content['not_finite']:,}"],
        ["largest speed seen", f"{content['fastest']:.3g} m/s"],
        ["largest angular velocity seen", f"{content['fastest_spin']:.3g} rad/s"],
        ["farthest from the start", f"{content['farthest']:,.0f} m"],
        ["largest deviation of a quaternion's length from 1", f"{content['attitude_error']:.1e}"],
        [f"wall time, {named(content['threads'])}", f"{content['seconds']:,.0f} s"],
    ]
    return table(["", ""], lines)


def headline(content: dict[str, Any]) -> str:
    """Return the counts."""
    return (
        f"{content['bodies']:,} bodies for {content['minutes'] / 60.0:.4g} h: {content['not_finite']} not finite, "
        f"{content['fallbacks']:,} of {body_steps(content):,} steps by the fallback, "
        f"{content['refused']:,} calls refused"
    )


SECTION = Section("endurance", "Endurance", METHOD, measure, tables, headline)
