"""The command `dq-marine fly`: one episode to look at."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples, shown_part
from dq_marine.cli.options import (
    SECONDS,
    Baseline,
    CurrentOption,
    EnvironmentPresetOption,
    LevelOption,
    PerturbOption,
    PolicyOption,
    PrintPresetOption,
    ScenarioOption,
    SetOption,
    StartSeedOption,
    TaskOption,
    VehicleOption,
    print_preset,
)
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.agents.evaluation.episodes import Episode
    from dq_marine.agents.evaluation.flight import FlightPlan, Outputs
    from dq_marine.agents.interactive.flights import MakeAgents

SECONDS_WITH_PANEL = 3600.0
"""How long a flight with a panel is if nobody says so [s]: the person ends it before."""

EXAMPLES = examples(
    "dq-marine fly --teleop --current 0.3",
    "dq-marine fly --teleop --record flights --html last.html",
    "dq-marine fly --panel --task PathFollowing --vehicle remus100",
    "dq-marine fly --live --start-distance 2",
    "dq-marine fly --scenario StationKeeping/cross_current --live",
    "dq-marine fly --scenario my_scenario.toml --run runs/ppo --html policy.html",
    "dq-marine fly --run runs/ppo --html ppo.html --plot ppo.png --seed 3",
    "dq-marine fly --policy policy.onnx --html policy.html",
    "dq-marine fly --mp4 flight.mp4 --fps 30",
    "dq-marine fly --agent zero --current 0.2,-0.1,0 --seconds 60 --html drift.html",
    "dq-marine fly --set actuation=thrusters --trajectory flight.csv",
    """dq-marine fly --set 'weather=\\[{"kind": "wind", "speed": 8}]' --vehicle otter --agent zero --plot otter.png""",
)


def fly(
    agent: Annotated[
        Baseline | None, typer.Option("--agent", help="Agent that flies.", show_default="controller")
    ] = None,
    run: Annotated[
        Path | None,
        typer.Option("--run", help="Folder of a training run: its policy flies. Load only runs you trust."),
    ] = None,
    policy: PolicyOption = None,
    html: Annotated[Path | None, typer.Option("--html", help="Write a replay into this file.")] = None,
    mp4: Annotated[
        Path | None,
        typer.Option("--mp4", help="Write a video that runs in real time into this file (.mp4)."),
    ] = None,
    fps: Annotated[
        float | None,
        typer.Option(
            "--fps",
            help="Pictures a second of the video.",
            show_default="one in each control period, up to 60 a second",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", help="Draw metrics and actions into this file (.png, .svg, .pdf)."),
    ] = None,
    trajectory: Annotated[
        Path | None,
        typer.Option(
            "--trajectory",
            help="Write time, pose, velocity, actions, reward and metrics into this file (.csv, .parquet).",
        ),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(
            "--record",
            help="With --teleop or --panel: keep all that is flown as Minari datasets in this folder.",
        ),
    ] = None,
    live: Annotated[
        bool,
        typer.Option(
            "--live",
            help="Show the flight in the browser, in real time. This is the default if no file is named.",
        ),
    ] = False,
    panel: Annotated[
        bool,
        typer.Option(
            "--panel",
            help="Fly in the browser with a panel: play, pause, step, speed, who flies, the current, the camera; until "
            "you quit.",
        ),
    ] = False,
    teleop: Annotated[
        bool,
        typer.Option(
            "--teleop",
            help="Take the helm yourself, by keyboard, gamepad or mouse in the browser: as --panel.",
        ),
    ] = False,
    seed: StartSeedOption = None,
    scenario: ScenarioOption = None,
    preset: EnvironmentPresetOption = None,
    task: TaskOption = None,
    vehicle: VehicleOption = None,
    level: LevelOption = None,
    current: CurrentOption = None,
    perturb: PerturbOption = None,
    set_: SetOption = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            "--seconds",
            help="Simulated time, in seconds.",
            show_default="30; as long as a scenario lasts; with a panel an hour",
        ),
    ] = None,
    start_distance: Annotated[
        float | None,
        typer.Option(
            "--start-distance", help="Distance of the start from the goal, in metres.", show_default="drawn"
        ),
    ] = None,
    only_print: PrintPresetOption = False,
) -> None:
    """Fly one episode: live in the browser, into a replay, a video or a plot, into a table of numbers.

    A scenario is an episode that can be repeated: its start, its currents and its seed are fixed.
    """
    from dq_marine.agents.choice import make_agents
    from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, episode_table
    from dq_marine.agents.evaluation.flight import fly as fly_once
    from dq_marine.cli.agent_options import EnvironmentOptions, requested_environment, requested_policies
    from dq_marine.envs.scenarios.files import load_scenario

    named = {"--agent": agent, "--run": run, "--policy": policy}
    given = [f"{option} {value}" for option, value in named.items() if value is not None]
    if len(given) > 1:
        number = {2: "two", 3: "three"}[len(given)]
        raise InvalidInputError(f"{' and '.join(given)} name {number} agents; give one of them")
    runs = requested_policies([policy]) if policy is not None else [] if run is None else [run]
    baselines = [] if runs else [agent or Baseline.CONTROLLER]
    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    begun = None if scenario is None else load_scenario(scenario, task=task)
    environment = requested_environment(runs, options, preset=preset, scenario=begun)
    if record is not None and not (panel or teleop):
        raise InvalidInputError(
            f"--record {record} keeps what is flown in a live page with a panel; add --teleop or --panel, or give "
            "--trajectory for other flights"
        )
    if only_print:
        print_preset(environment, "environment")
        return
    if begun is not None and start_distance is not None:
        raise InvalidInputError(
            f"--start-distance {start_distance:g} and --scenario {scenario} both say where to start; give one of them"
        )
    if fps is not None and mp4 is None:
        raise InvalidInputError(f"--fps {fps:g} is about a video; name its file with --mp4, or leave it out")
    title = f"{policy or run or baselines[0]}, seed {{seed}}"
    if seconds is None and (panel or teleop):
        seconds = SECONDS_WITH_PANEL
    elif seconds is None and begun is None:
        seconds = SECONDS
    if begun is None:
        plan = FlightPlan(environment, seconds, seed, start_distance)
    else:
        plan = FlightPlan(environment, seconds, begun.seed if seed is None else seed, start=begun.reset)
    recorded: dict[str, int] = {}
    with shown_part("Drawing the video") as progress:
        files = Outputs(html=html, plot=plot, trajectory=trajectory, mp4=mp4, fps=fps, progress=progress)
        if panel or teleop:
            from dq_marine.agents.interactive.flights import offered_agents

            offer = partial(offered_agents, baselines=baselines, runs=runs, seed=plan.seed or 0)
            episode, recorded = _fly_with_panel(
                plan, offer, files, title=title, teleoperated=teleop, folder=record
            )
        else:
            episode = fly_once(
                plan,
                lambda env: next(iter(make_agents(baselines, runs, env, seed=plan.seed or 0).values())),
                replace(files, live=live or not files.files),
                title=title,
            )
    console.print(episode_table(episode))
    for note in episode.notes:
        console.print(note, highlight=False, markup=False)
    for path in files.files:
        console.print(f"Wrote {path}", soft_wrap=True)
    for identifier, episodes in recorded.items():
        console.print(f"Wrote {record}: dataset {identifier}, episodes: {episodes}", soft_wrap=True)


def _fly_with_panel(
    plan: FlightPlan,
    offer: MakeAgents,
    files: Outputs,
    *,
    title: str,
    teleoperated: bool,
    folder: Path | None,
) -> tuple[Episode, dict[str, int]]:
    """Return the last episode, and how many each dataset in the folder has, if one is given."""
    from dq_marine.agents.interactive.flying import fly_interactively
    from dq_marine.agents.interactive.recording import Recorder

    with nullcontext() if folder is None else Recorder(folder) as recorder:
        episode = fly_interactively(
            plan, offer, files, title=title, teleoperated=teleoperated, recorder=recorder
        )
    return episode, {} if recorder is None else recorder.written
