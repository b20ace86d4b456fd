"""The command line, `dq-marine`: each command says what it does and hands over to `dq_marine.agents`.

Everything heavy is imported inside the commands, so that `dq-marine --help` answers at once and needs nothing
beyond the core.
"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from dq_marine import __version__
from dq_marine.command_basics import HELP_OPTIONS, Commands, console, examples
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvre_commands import app as manoeuvre_app
from dq_marine.sea_commands import EXAMPLES as SEA_EXAMPLES
from dq_marine.sea_commands import sea
from dq_marine.vehicle_commands import app as vehicles_app

app = typer.Typer(
    cls=Commands,
    name="dq-marine",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings=HELP_OPTIONS,
)
app.add_typer(vehicles_app, name="vehicles")
app.command(epilog=SEA_EXAMPLES)(sea)
app.add_typer(manoeuvre_app, name="manoeuvre")


class Algorithm(StrEnum):
    """What `train --algorithm` takes."""

    PPO = "ppo"
    SAC = "sac"


class Baseline(StrEnum):
    """What `--agent` takes."""

    CONTROLLER = "controller"
    ZERO = "zero"
    RANDOM = "random"


VehicleOption = Annotated[
    str | None,
    typer.Option(
        "--vehicle",
        help="Catalogue name, or path of a TOML file.",
        show_default="bluerov2_heavy, or the run's",
    ),
]
CurrentOption = Annotated[
    str | None,
    typer.Option(
        "--current",
        help="Speed in m/s: every episode draws a horizontal current of up to it. Or three components in NED, "
        "always the same: 0.2,-0.1,0.",
        show_default="0.3, or the run's",
    ),
]


def _show_version(asked: bool) -> None:
    if asked:
        console.print(f"dq-marine {__version__}", highlight=False)
        raise typer.Exit


@app.callback(epilog="Start here:  [bold]dq-marine demo[/bold]")
def main(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Marine vehicles on a dual quaternion variational integrator: fly, train, evaluate."""


@app.command(epilog=examples("dq-marine demo", "dq-marine demo --out my_demo"))
def demo(
    out: Annotated[Path, typer.Option("--out", help="Folder for replay.html and errors.png.")] = Path("demo"),
) -> None:
    """Watch a PID controller hold station in a current.

    Writes a replay to open in any browser, and a plot of errors and thrust. Where there is a display, it also flies
    live.
    """
    from dq_marine.agents.demo import run_demo

    run_demo(out, console)


@app.command(
    epilog=examples(
        "dq-marine fly --live --start-distance 2",
        "dq-marine fly --run runs/ppo --html ppo.html --plot ppo.png --seed 3",
        "dq-marine fly --agent zero --current 0.2,-0.1,0 --seconds 60 --html drift.html",
    )
)
def fly(
    agent: Annotated[
        Baseline | None, typer.Option("--agent", help="Who flies.", show_default="controller")
    ] = None,
    run: Annotated[
        Path | None,
        typer.Option("--run", help="Folder of a training run: its policy flies. Load only runs you trust."),
    ] = None,
    html: Annotated[Path | None, typer.Option("--html", help="Write a replay into this file.")] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw errors and actions into this file (.png, .svg, .pdf).")
    ] = None,
    live: Annotated[
        bool,
        typer.Option("--live", help="Show it in the browser, at real time. So it is if no file is named."),
    ] = False,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of start and current.")] = 0,
    vehicle: VehicleOption = None,
    current: CurrentOption = None,
    seconds: Annotated[float, typer.Option("--seconds", help="Simulated time, in seconds.")] = 30.0,
    start_distance: Annotated[
        float | None,
        typer.Option("--start-distance", help="From the goal, in metres.", show_default="drawn"),
    ] = None,
) -> None:
    """Fly one episode: live in the browser, into a replay, into a plot."""
    from dq_marine.agents.command_options import requested_environment
    from dq_marine.agents.flight import FlightPlan, Outputs, episode_table
    from dq_marine.agents.flight import fly as fly_once
    from dq_marine.agents.pilots import make_agents

    if agent is not None and run is not None:
        raise InvalidInputError(f"--agent {agent} and --run {run} name two pilots; give one of them")
    runs = [] if run is None else [run]
    baselines = [agent or Baseline.CONTROLLER] if run is None else []
    environment = requested_environment(runs, vehicle=vehicle, current=current)
    episode = fly_once(
        FlightPlan(environment, seconds, seed, start_distance),
        lambda env: next(iter(make_agents(baselines, runs, env, seed=seed).values())),
        Outputs(live=live or (html is None and plot is None), html=html, plot=plot),
        title=f"{run or baselines[0]}, seed {seed}",
    )
    console.print(episode_table(episode))
    for path in (html, plot):
        if path is not None:
            console.print(f"Wrote {path}", soft_wrap=True)


@app.command(
    epilog=examples(
        "dq-marine evaluate",
        "dq-marine evaluate --run runs/ppo --agent controller --agent zero --episodes 100",
    )
)
def evaluate(
    agent: Annotated[
        list[Baseline] | None,
        typer.Option(
            "--agent", help="A baseline; may be repeated.", show_default="all, if no --run is given"
        ),
    ] = None,
    run: Annotated[
        list[Path] | None,
        typer.Option("--run", help="Folder of a training run; may be repeated. Load only runs you trust."),
    ] = None,
    episodes: Annotated[int, typer.Option("--episodes", min=1, help="Of each agent.")] = 50,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Of the first episode; they count up from it.")
    ] = 0,
    vehicle: VehicleOption = None,
    current: CurrentOption = None,
    json: Annotated[Path | None, typer.Option("--json", help="Write the scores into this file, too.")] = None,
) -> None:
    """Compare agents over the same seeded episodes: errors, returns, success."""
    from rich.progress import Progress

    from dq_marine.agents.atomic import write_json
    from dq_marine.agents.command_options import requested_environment
    from dq_marine.agents.environments import make_environment
    from dq_marine.agents.evaluation import evaluate as evaluate_agents
    from dq_marine.agents.evaluation import score_table
    from dq_marine.agents.pilots import make_agents

    runs = run or []
    baselines = agent or ([] if runs else list(Baseline))
    environment = requested_environment(runs, vehicle=vehicle, current=current)
    env = make_environment(environment)
    agents = make_agents(baselines, runs, env, seed=seed)
    with Progress(console=console, transient=True) as bar:
        task = bar.add_task("evaluating", total=episodes * len(agents))

        def advance(name: str) -> None:
            bar.update(task, advance=1, description=f"evaluating {name}")

        scores = evaluate_agents(env, agents, episodes=episodes, seed=seed, after_episode=advance)
    console.print(score_table(scores))
    if json is not None:
        settings = environment.model_dump(mode="json")
        content = {"environment": settings, "seed": seed, "scores": [score.as_dict() for score in scores]}
        write_json(json, content)
        console.print(f"Wrote {json}", soft_wrap=True)


@app.command(
    epilog=examples(
        "dq-marine train --run runs/ppo",
        "dq-marine train --run runs/ppo --resume",
        "dq-marine train --run runs/sac --algorithm sac --seed 1",
        "dq-marine train --run runs/mine --preset my_preset.toml --vehicle my_vehicle.toml",
        "tensorboard --logdir runs",
    )
)
def train(
    run: Annotated[Path, typer.Option("--run", help="Folder for checkpoints, the best model and logs.")],
    algorithm: Annotated[
        Algorithm | None,
        typer.Option("--algorithm", help="With the preset of its name.", show_default="ppo, or the preset's"),
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            "--preset", help="A preset's name, or path of a TOML file.", show_default="the algorithm's"
        ),
    ] = None,
    timesteps: Annotated[
        int | None,
        typer.Option("--timesteps", min=1, help="In all, with --resume too.", show_default="the preset's"),
    ] = None,
    envs: Annotated[
        int | None,
        typer.Option("--envs", min=1, help="Environments to learn from.", show_default="the preset's"),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option("--seed", min=0, help="Of networks, starts and currents.", show_default="0"),
    ] = None,
    vehicle: VehicleOption = None,
    current: CurrentOption = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the run's latest checkpoint.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the run in the folder.")] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Open a page that follows one of the environments.")
    ] = False,
) -> None:
    """Train an agent with PPO or SAC; a run that was killed can be resumed."""
    from dq_marine.agents.command_options import requested_training
    from dq_marine.agents.run_folder import RunFolder

    folder = RunFolder(run)
    if resume:
        _refuse_with_resume(
            algorithm=algorithm,
            preset=preset,
            envs=envs,
            seed=seed,
            vehicle=vehicle,
            current=current,
            force=force,
        )
        settings = None
    else:
        settings = requested_training(
            algorithm=algorithm,
            preset=preset,
            timesteps=timesteps,
            envs=envs,
            vehicle=vehicle,
            current=current,
        )
    # Only now, after a look at the options: it imports torch, which takes seconds.
    from dq_marine.agents.training import begin_training, resume_training, summary_table

    try:
        if settings is None:
            summary = resume_training(folder, timesteps=timesteps, console=console, watch=watch)
        else:
            summary = begin_training(
                folder, settings, seed=seed or 0, force=force, console=console, watch=watch
            )
    except KeyboardInterrupt:
        done = folder.progress("checkpoints").timesteps
        console.print(
            f"Stopped; {done:,} timesteps are saved. Go on: dq-marine train --run {run} --resume",
            soft_wrap=True,
        )
        raise typer.Exit(130) from None
    console.print(summary_table(summary))
    console.print(f"Next: dq-marine evaluate --run {run} --agent controller --agent zero", soft_wrap=True)


def _refuse_with_resume(**options: object) -> None:
    """Refuse what cannot change: a run goes on as it was begun."""
    given = [f"--{name}" for name, value in options.items() if value is not None and value is not False]
    if given:
        raise InvalidInputError(
            f"{', '.join(given)} cannot go with --resume: a run goes on as it was begun; leave it out, or train in "
            "another folder"
        )


@app.command(
    epilog=examples(
        "dq-marine report --quick",
        "dq-marine report --out my_report",
        "dq-marine report --only work_precision --case kirchhoff_bluerov2",
    )
)
def report(
    quick: Annotated[
        bool,
        typer.Option("--quick", help="A small version, in two minutes; the full one takes some ten."),
    ] = False,
    out: Annotated[Path, typer.Option("--out", help="Folder for the page and the points.")] = Path("report"),
    only: Annotated[
        list[str] | None,
        typer.Option("--only", help="A study to measure; may be repeated.", show_default="all"),
    ] = None,
    case: Annotated[
        list[str] | None,
        typer.Option("--case", help="A case of work_precision; may be repeated.", show_default="all"),
    ] = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="Measure again what was measured before.")] = False,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of what is drawn.")] = 0,
) -> None:
    """Compare the integrator with others: error against run time, long runs, stability, extremes.

    Writes a page to read, and every point. What was measured before is kept, unless the sources have changed. Fails if
    what was measured contradicts theory.
    """
    from dq_marine.report.command import Request, make_report
    from dq_marine.report.plan import Plan
    from dq_marine.report.runner import InterruptedRunError

    request = Request(out, tuple(only or ()), Plan(quick, seed, tuple(case or ())), fresh)
    try:
        page = make_report(request, console)
    except InterruptedRunError as stopped:
        console.print(
            f"Stopped; {stopped.measured} of {stopped.wanted} parts are measured and kept. Go on: {request.command}",
            soft_wrap=True,
        )
        raise typer.Exit(130) from None
    if page.failures:
        raise typer.Exit(1)
