"""The integrator beside RK4, in steps that are too large for RK4: one motion, to be seen.

A BlueROV2 Heavy with its own damping under an oscillating thrust, the case that the study of stability takes further.
An explicit method is stable while h lambda is below some bound, 2.785 for RK4 (Hairer and Wanner, Solving Ordinary
Differential Equations II, IV.2), and the quadratic part of damping makes lambda grow with the speed: once beyond the
bound, the speed itself takes the step ever farther beyond.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.table import Table

from dq_marine.checks import finite_number
from dq_marine.envs.core.view import shape_of
from dq_marine.errors import InvalidInputError
from dq_marine.report.cases import CASES, Case
from dq_marine.report.methods import METHODS
from dq_marine.report.stability_map import BOUNDED
from dq_marine.report.trial import BLEW_UP, DONE, overflow_allowed, trial
from dq_marine.simulation.one_body import OneBody
from dq_marine.vehicles import load_vehicle
from dq_marine.viewer.overlay import save_overlay
from dq_marine.viewer.shared_scene import Flight
from dq_marine.viewer.snapshot import Snapshot

VEHICLE, CASE = "bluerov2_heavy", "damped_bluerov2"
OWN, RK4 = "dqvi2", "rk4_quaternion"
STEP, DURATION = 0.5, 20.0
LONGEST, MOST_STEPS = 1e4, 100_000
"""Duration [s], and steps of the compared methods, that are not refused."""

REFINEMENT, SEEN = 50, 10
"""How many times smaller the steps of the reference are, and how many of its states are shown in a step."""

DEPTH = 5.0
"""Of the start [m]."""

FARTHEST = 1e6
"""Largest coordinate at which a runaway is still drawn [m]."""

FLOOR = 10.0
"""Depth of the sea floor [m]; a runaway does not deepen it."""

RAN_AWAY = "ran away"
"""Beyond `BOUNDED` times the speeds at the start, or 1 m/s if that is more: the motion itself stays near 1 m/s."""


@dataclass(frozen=True)
class Run:
    """What became of the motion by a method.

    Attributes:
        flight: as far as its state is finite and it does not run away.
        method: of `report.methods`.
        step: size [s].
        steps: that were done, with the one that failed.
        outcome: `DONE`, `RAN_AWAY`, `BLEW_UP`, or why a step was refused.
        fastest: the largest of the finite speeds [m/s].
    """

    flight: Flight
    method: str
    step: float
    steps: int
    outcome: str
    fastest: float


def blow_up(
    step: float = STEP, duration: float = DURATION, *, progress: Callable[[float], None] = lambda done: None
) -> list[Run]:
    """Return the motion by DQVI of order 2 and by RK4 in the same steps, and by RK4 in much smaller ones.

    Args:
        step: size [s].
        duration: [s], a step at least.
        progress: is told what part is done, from 0 to 1.

    Raises:
        InvalidInputError: a step that is not above 0, or a duration that has no or too many steps.
    """
    finite_number("step", step)
    finite_number("duration", duration)
    if not 0.0 < step <= duration <= LONGEST or duration / step > MOST_STEPS:
        raise InvalidInputError(
            f"step = {step:g} s and duration = {duration:g} s; give a step above 0 and a duration from one step to "
            f"{LONGEST:g} s with at most {MOST_STEPS} steps"
        )
    runs = []
    wanted = ((OWN, 1, 1), (RK4, 1, 1), (RK4, REFINEMENT, REFINEMENT // SEEN))
    for number, (method, refinement, stride) in enumerate(wanted):
        runs.append(run(CASES[CASE], method, step / refinement, round(duration / step) * refinement, stride))
        progress((number + 1) / len(wanted))
    return runs


@overflow_allowed
def run(case: Case, method: str, step: float, steps: int, stride: int) -> Run:
    """Return a case by a method, from `DEPTH`, until its steps are done or it fails.

    Args:
        case: the motion.
        method: of `report.methods`.
        step: size [s].
        steps: how many.
        stride: one state in so many steps is shown.
    """
    body = trial(METHODS[method], case.physics, step)
    body.reset((0.0, 0.0, DEPTH), case.quaternion, case.velocity)
    bound = BOUNDED * max(float(np.abs(case.velocity).max()), 1.0)
    snapshots, speeds = [seen(body)], [speed_of(body)]
    fastest, outcome, done = speeds[0], DONE, 0
    while outcome == DONE and done < steps:
        outcome, done = body.attempt(case.wrench), done + 1
        if outcome == DONE and np.abs(body.velocity_body).max() > bound:
            outcome = RAN_AWAY
        fastest = max(fastest, speed_of(body))
        if outcome == RAN_AWAY or (outcome == DONE and done % stride == 0):
            snapshots.append(seen(body))
            speeds.append(speed_of(body))
    if np.abs(snapshots[-1].position_ned).max() > FARTHEST:
        snapshots, speeds = snapshots[:-1], speeds[:-1]
    flight = Flight(
        name=f"{METHODS[method].title}, step {step:g} s",
        snapshots=snapshots,
        shape=shape_of(load_vehicle(VEHICLE)),
        caption=caption(outcome, done, steps, step, speed_of(body)),
        plots={"speed [m/s]": speeds},
    )
    return Run(flight, method, step, done, outcome, fastest)


def seen(body: OneBody) -> Snapshot:
    """Return a body as it is drawn now."""
    return Snapshot(
        time=body.time,
        position_ned=body.position_ned,
        quaternion_body_to_ned=body.quaternion_body_to_ned,
        wrench_body=np.zeros(6),
        current_ned=np.zeros(3),
    )


def speed_of(body: OneBody) -> float:
    """Return the speed of a body's origin [m/s]."""
    return float(np.linalg.norm(body.velocity_body[:3]))


def caption(outcome: str, done: int, steps: int, step: float, speed: float) -> str:
    """Return in words what became of a motion."""
    at = f"at step {done} of {steps}, {done * step:.4g} s"
    if outcome == DONE:
        return f"does all {steps} steps"
    if outcome == RAN_AWAY:
        return f"runs away {at}: {speed:.3g} m/s"
    if outcome == BLEW_UP:
        return f"blows up {at}: no longer finite"
    return f"refused {at}: {outcome}"


def run_table(runs: Sequence[Run]) -> Table:
    """Return what became of the motion by each method."""
    table = Table()
    table.add_column("method")
    table.add_column("fastest [m/s]", justify="right")
    table.add_column("outcome")
    for one in runs:
        table.add_row(one.flight.name, f"{one.fastest:.4g}", one.flight.caption)
    return table


def save_page(path: Path, runs: Sequence[Run]) -> None:
    """Write the motions as one page, overlaid.

    Raises:
        InvalidInputError: the path cannot be written.
        MissingDependencyError: meshcat is not installed.
    """
    title = "BlueROV2 Heavy under an oscillating thrust, by DQVI and by RK4"
    save_overlay(path, [one.flight for one in runs], floor_depth=FLOOR, title=title)
