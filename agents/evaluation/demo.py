"""The demonstration: the baseline controller comes from 2 m away, in a current, and holds station."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, episode_table, fly
from dq_marine.errors import InvalidInputError
from dq_marine.viewer.live import display_present

PLAN = FlightPlan(
    DEFAULT_ENVIRONMENT,
    seed=0,
    start={
        "position": (-1.6, -1.2, 5.0),  # 2 m from the goal at (0, 0, 5)
        "quaternion": (0.5, 0.0, 0.0, 0.8660254037844386),  # heading 120 degrees
        "velocity": (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        "current": (0.24, -0.18, 0.0),  # 0.3 m/s, across the way
    },
)
"""The flight, without anything drawn at random."""

TITLE = "BlueROV2 Heavy, PID controller, 2 m to go in a current of 0.3 m/s"

WHAT_IS_SEEN = """\
The BlueROV2 starts 2 m from its goal, the green ghost, and heads 120 degrees away from it. It turns while it crosses
a current that it cannot measure (white arrows), brakes, and then holds still against the water with steady thrust
(red arrow). The yellow line is the way it came."""


def run_demo(folder: Path, console: Console) -> None:
    """Fly, write `replay.html` and `errors.png` into a folder, and show it live where there is a display.

    Args:
        folder: made if need be.
        console: to tell progress on.

    Raises:
        InvalidInputError: the folder cannot be made.
        MissingDependencyError: the viewer's or the plot's libraries are not installed.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(
            f"{folder} cannot be made: {error.strerror}; give another with --out"
        ) from error
    replay, plot = folder / "replay.html", folder / "errors.png"
    console.print("Flying 30 simulated seconds, then drawing them ...")
    episode = fly(PLAN, DPController.for_env, Outputs(html=replay, plot=plot), title=TITLE)
    console.print(WHAT_IS_SEEN, soft_wrap=True)
    console.print(episode_table(episode))
    console.print(f"Replay: {replay} (open it in a browser: play, pause, drag the slider)", soft_wrap=True)
    console.print(f"Plot:   {plot} (errors and actions against time)", soft_wrap=True)
    if display_present():
        console.print("Now the same, live and at real time (Ctrl-C ends it):")
        fly(PLAN, DPController.for_env, Outputs(live=True), title=TITLE)
