"""The demonstration: three tasks flown by their baselines, one by a policy, too, side by side in one page."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym
from rich.console import Console

from dq_marine.agents.controllers.baselines import Agent, controller_for
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, episode_table, fly
from dq_marine.agents.policies import load_policy
from dq_marine.agents.policy_names import shipped_policies
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.live import display_present


@dataclass(frozen=True)
class Flight:
    """One of them: where its replay goes, how it is flown, and what is seen.

    Attributes:
        file: name of the replay.
        title: above it.
        plan: nothing of it is drawn at random.
        seen: what to look at.
        agent: what flies it.
    """

    file: str
    title: str
    plan: FlightPlan
    seen: str
    agent: Callable[[gym.Env[Any, Any]], Agent] = controller_for


def trained(env: gym.Env[Any, Any]) -> Agent:
    """Return the policy for station keeping that comes with the package."""
    return load_policy(shipped_policies()["StationKeeping"])


STATION = Flight(
    "replay.html",
    "BlueROV2 Heavy, PID controller, 2 m to go in a current of 0.3 m/s",
    FlightPlan(
        DEFAULT_ENVIRONMENT,
        seed=0,
        start={
            "position": (-1.6, -1.2, 5.0),  # 2 m from the goal at (0, 0, 5)
            "quaternion": (0.5, 0.0, 0.0, 0.8660254037844386),  # heading 120 degrees
            "velocity": (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            "current": (0.24, -0.18, 0.0),  # 0.3 m/s, across the way
        },
    ),
    "The BlueROV2 starts 2 m from its goal, the green ghost, and heads 120 degrees away from it. It turns while it "
    "crosses a current that it cannot measure (white arrows), brakes, and then holds still against the water with "
    "steady thrust (red arrow). The yellow line is the way it came.",
    DPController.for_env,
)

TRAINED = Flight(
    "trained.html",
    "The same, flown by a policy that learned it",
    STATION.plan,
    "The same start in the same current. The policy has learned with vehicles whose masses, damping and added masses "
    "were drawn at random, and flies one that it has never seen.",
    trained,
)

DOCKING = Flight(
    "docking.html",
    "BlueROV2 Heavy, docking: a funnel that heaves, in a current of 0.2 m/s",
    FlightPlan(
        EnvironmentSettings(id="dq_marine/Docking-v0", keywords={"level": "medium"}), seconds=60.0, seed=0
    ),
    "It waits before the mouth until it moves with the dock, and goes in slowly.",
)

ENCOUNTER = Flight(
    "encounter.html",
    "Otter, meeting two vessels by the rules of the road (Imazu's case 12)",
    FlightPlan(
        EnvironmentSettings(id="dq_marine/Encounter-v0", keywords={"case": 12}), seconds=120.0, seed=0
    ),
    "The grey vessels keep course and speed. The Otter gives way to the right side, and returns to its route.",
)

FLIGHTS = (STATION, TRAINED, DOCKING, ENCOUNTER)


def possible_flights() -> tuple[Flight, ...]:
    """Return the flights that the installed libraries allow: without onnxruntime those without a policy."""
    if importlib.util.find_spec("onnxruntime") is None:
        return tuple(flight for flight in FLIGHTS if flight is not TRAINED)
    return FLIGHTS


def run_demo(folder: Path, console: Console) -> None:
    """Fly, write replays, their common page and a plot into a folder, and fly live where there is a display.

    Args:
        folder: made if need be.
        console: to tell progress on.

    Raises:
        InvalidInputError: the folder cannot be made.
        MissingDependencyError: the viewer's or the plot's libraries are not installed.
    """
    from dq_marine.viewer.side_by_side import save_side_by_side

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(
            f"{folder} cannot be made: {error.strerror}; give another with --out"
        ) from error
    plot, page = folder / "errors.png", folder / "index.html"
    flights = possible_flights()
    for number, flight in enumerate(flights, start=1):
        console.print(f"{number} of {len(flights)}: {flight.title} ...", soft_wrap=True)
        outputs = Outputs(html=folder / flight.file, plot=plot if flight is STATION else None)
        episode = fly(flight.plan, flight.agent, outputs, title=flight.title)
        console.print(flight.seen, soft_wrap=True)
        console.print(episode_table(episode))
    save_side_by_side(page, {flight.title: folder / flight.file for flight in flights})
    console.print(
        f"All of them: {page} (open it in a browser: play, pause, drag the sliders)", soft_wrap=True
    )
    for flight in flights:
        console.print(f"Replay:    {folder / flight.file}", soft_wrap=True)
    console.print(f"Plot:      {plot} (errors and actions of the first against time)", soft_wrap=True)
    if display_present():
        console.print("Now the first, live and at real time (Ctrl-C ends it):")
        fly(STATION.plan, STATION.agent, Outputs(live=True), title=STATION.title)
