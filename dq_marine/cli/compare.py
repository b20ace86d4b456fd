"""The command `dq-marine compare`: flights from one start in one page."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dq_marine.cli.common import console, examples, shown_part
from dq_marine.cli.options import (
    SECONDS,
    Baseline,
    CurrentOption,
    EnvironmentPresetOption,
    LevelOption,
    PerturbOption,
    PoliciesOption,
    RunsOption,
    ScenarioOption,
    SetOption,
    StartSeedOption,
    TaskOption,
    VehicleOption,
    baselines_option,
)
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.agents.controllers.baselines import Agent
    from dq_marine.agents.evaluation.comparison import Contender
    from dq_marine.agents.settings import EnvironmentSettings

EXAMPLES = examples(
    "dq-marine compare",
    "dq-marine compare --agent controller --agent zero --scenario StationKeeping/cross_current",
    "dq-marine compare --agent controller --run runs/ppo --seed 3 --html policy.html",
    "dq-marine compare --agent controller --policy policy.onnx",
    "dq-marine compare --task TrajectoryTracking --agent controller --agent lqr --agent mpc",
    'dq-marine compare --with "order 2: order=2" --with "order 8: scheme=galerkin, order=8" --set substeps=1',
    'dq-marine compare --with "calm: current=0" --with "stream: current=0.3,0,0" --side-by-side',
    "dq-marine compare --integrators",
)


def compare(
    agent: Annotated[
        list[Baseline] | None,
        baselines_option("controller and zero; controller beside settings, a run or a policy"),
    ] = None,
    run: RunsOption = None,
    policy: PoliciesOption = None,
    with_: Annotated[
        list[str] | None,
        typer.Option(
            "--with",
            metavar="NAME: KEY=VALUE, ...",
            help="Settings to compare, and what they are called; may be repeated. Keys and values as of --set.",
        ),
    ] = None,
    html: Annotated[Path, typer.Option("--html", help="Write the page into this file.")] = Path(
        "compare.html"
    ),
    side_by_side: Annotated[
        bool,
        typer.Option(
            "--side-by-side", help="Show each flight in a scene of its own.", show_default="overlaid"
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
            "--seconds", help="Simulated time, in seconds.", show_default="30; as long as a scenario lasts"
        ),
    ] = None,
    integrators: Annotated[
        bool,
        typer.Option(
            "--integrators",
            help="Show instead the integrator and RK4 from one start, in steps that are too large for RK4, which blows "
            "up; of the other options --html, --step and --seconds count.",
        ),
    ] = False,
    step: Annotated[
        float | None,
        typer.Option("--step", help="With --integrators: step size, in seconds.", show_default="0.5"),
    ] = None,
) -> None:
    """Fly agents or settings from one start, and show the flights in one page, overlaid in one scene.

    Several agents under several settings are flown in all combinations. Prints the task's own metrics of each flight.
    """
    if integrators:
        given = {
            "--agent": agent, "--run": run, "--policy": policy, "--with": with_, "--seed": seed, "--scenario": scenario,
            "--preset": preset, "--task": task, "--vehicle": vehicle, "--level": level, "--current": current,
            "--set": set_, "--side-by-side": side_by_side or None,
        }  # fmt: skip
        stray = [name for name, value in given.items() if value is not None]
        if stray:
            raise InvalidInputError(
                f"{', '.join(stray)} does not go with --integrators, which shows a motion of its own; leave one out"
            )
        _compare_integrators(html, step, seconds)
        return
    from dq_marine.agents.evaluation.comparison import comparison_table, fly_contenders, save_comparison
    from dq_marine.agents.evaluation.flight import FlightPlan
    from dq_marine.cli.agent_options import EnvironmentOptions, requested_environment, requested_policies
    from dq_marine.cli.variants import read_variants
    from dq_marine.envs.scenarios.files import load_scenario
    from dq_marine.viewer.shared_scene import check_number

    if step is not None:
        raise InvalidInputError(
            f"--step {step:g} goes with --integrators; the step of a flight is --set control_period=... or substeps=..."
        )
    options = EnvironmentOptions(task, vehicle, level, current, tuple(set_ or ()), tuple(perturb or ()))
    begun = None if scenario is None else load_scenario(scenario, task=task)
    runs, variants = [*(run or []), *requested_policies(policy or [])], read_variants(with_ or [])
    environment = requested_environment(runs, options, preset=preset, scenario=begun)
    alone = [Baseline.CONTROLLER] if runs or variants else [Baseline.CONTROLLER, Baseline.ZERO]
    contenders = _contenders(agent or alone, runs, environment, variants)
    if not side_by_side:
        check_number(len(contenders))  # before the first flight, not after the last
    if begun is None:
        plan = FlightPlan(environment, SECONDS if seconds is None else seconds, seed)
    else:
        plan = FlightPlan(environment, seconds, begun.seed if seed is None else seed, start=begun.reset)
    with shown_part("Flying") as progress:
        flown = fly_contenders(contenders, plan, html, progress=progress)
    console.print(comparison_table(flown))
    for name, one in flown.items():
        for note in one.episode.notes:
            console.print(f"{name}: {note}", highlight=False, markup=False)
    what = environment.id.rpartition("/")[2].removesuffix("-v0") if begun is None else begun.full_name
    title = f"{what}, seed {next(iter(flown.values())).episode.seed}"
    flights = [one.flight for one in flown.values()]
    save_comparison(html, flights, title=title, side_by_side=side_by_side)
    console.print(f"Wrote {html}", soft_wrap=True)


def _compare_integrators(html: Path, step: float | None, seconds: float | None) -> None:
    from dq_marine.report.blow_up import DURATION, STEP, blow_up, run_table, save_page
    from dq_marine.util.files import check_folder

    check_folder(html)
    with shown_part("Flying") as progress:
        runs = blow_up(
            STEP if step is None else step, DURATION if seconds is None else seconds, progress=progress
        )
    save_page(html, runs)
    console.print(run_table(runs))
    console.print(f"Wrote {html}", soft_wrap=True)


def _contenders(
    baselines: list[Baseline],
    runs: list[Path],
    environment: EnvironmentSettings,
    variants: dict[str, dict[str, Any]],
) -> dict[str, Contender]:
    """Return each agent under each settings, by a name that says in what they differ."""
    from dq_marine.agents.choice import make_agents
    from dq_marine.agents.evaluation.comparison import Contender
    from dq_marine.agents.keywords import with_changes
    from dq_marine.agents.policies import named_policies

    agents: list[tuple[str, list[str], list[Path]]] = [(str(name), [str(name)], []) for name in baselines]
    agents += [(name, [], [one]) for name, one in named_policies(runs)]
    settings = [(name, with_changes(environment, changes)) for name, changes in variants.items()]
    contenders: dict[str, Contender] = {}
    for (flier, chosen, trained), (variant, changed) in product(agents, settings or [("", environment)]):
        several = len(agents) > 1 or not variant
        name = ", ".join([*([flier] if several else []), *([variant] if variant else [])])
        if name in contenders:
            raise InvalidInputError(f"there are two flights called {name!r}; give each agent and run once")

        def make(env: Any, seed: int, chosen: list[str] = chosen, trained: list[Path] = trained) -> Agent:
            return next(iter(make_agents(chosen, trained, env, seed=seed).values()))

        contenders[name] = Contender(changed, make)
    return contenders
