"""The command `dq-marine leaderboard`: every task with every vehicle, over many episodes, and in named scenarios."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples
from dq_marine.cli.options import (
    POLICY,
    AddressOption,
    Baseline,
    DistributedOption,
    ProcessesOption,
    baselines_option,
)
from dq_marine.errors import InvalidInputError

EXAMPLES = examples(
    "dq-marine leaderboard",
    "dq-marine leaderboard --task StationKeeping --episodes 20",
    "dq-marine leaderboard --vehicle remus100 --vehicle otter --level easy --level hard",
    "dq-marine leaderboard --task StationKeeping --perturb payload --perturb late_actions --perturb lost_thruster",
    "dq-marine leaderboard --scenarios",
    "dq-marine leaderboard --scenarios --episodes 0 --task Encounter --agent controller --agent zero",
    "dq-marine leaderboard --scenarios --task StationKeeping --agent controller --policy runs/ppo",
    "dq-marine leaderboard --scenarios --episodes 0 --policy policy.onnx --agent controller",
    "dq-marine leaderboard --distributed --address 10.0.0.1:6379",
)


def leaderboard(
    task: Annotated[
        list[str] | None,
        typer.Option("--task", help="Name or id of a task; may be repeated.", show_default="all that ship"),
    ] = None,
    vehicle: Annotated[
        list[str] | None,
        typer.Option("--vehicle", help="Catalogue name; may be repeated.", show_default="all that suit"),
    ] = None,
    level: Annotated[
        list[str] | None,
        typer.Option("--level", help="Of difficulty; may be repeated.", show_default="medium"),
    ] = None,
    perturb: Annotated[
        list[str] | None,
        typer.Option(
            "--perturb",
            metavar="NAME",
            help="What does not go as planned, as `dq-marine evaluate --help` lists it; may be repeated. Each is "
            "flown by itself, beside what is planned.",
        ),
    ] = None,
    agent: Annotated[list[Baseline] | None, baselines_option("controller, unless --policy is given")] = None,
    policy: Annotated[
        list[str] | None,
        typer.Option(
            "--policy",
            help=f"{POLICY}, or folder of a training run: it flies what it fits, its task, with its vehicle and "
            "sensors; may be repeated. Load only runs you trust.",
        ),
    ] = None,
    scenarios: Annotated[
        bool, typer.Option("--scenarios", help="Fly the named scenarios, too, each once by each agent.")
    ] = False,
    episodes: Annotated[
        int,
        typer.Option(
            "--episodes", min=0, help="Number of episodes of each; 0 leaves the scenarios alone to be flown."
        ),
    ] = 200,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Seed of the first episode; the others count up from it.")
    ] = 0,
    processes: ProcessesOption = None,
    distributed: DistributedOption = False,
    address: AddressOption = None,
    out: Annotated[
        Path, typer.Option("--out", help="The page; its figures are kept beside it, as .json.")
    ] = Path("leaderboard.md"),
    fresh: Annotated[bool, typer.Option("--fresh", help="Measure again what was measured before.")] = False,
) -> None:
    """Fly every task with every vehicle that it suits, and write how well agents do.

    The page has success with Wilson's interval, and of errors, effort and smoothness the interquartile mean with a
    bootstrap interval. Results are kept as they come: a run that was stopped goes on where it was, unless the sources
    have changed.
    """
    from rich.progress import Progress

    from dq_marine.cli.agent_options import requested_policies, requested_team
    from dq_marine.report.leaderboard import Entry, Kept, Plan, Result, entries, fly_all, scenario_entries
    from dq_marine.report.leaderboard_page import markdown
    from dq_marine.report.leaderboard_policies import policies_of
    from dq_marine.util.files import check_ending, check_folder, write_whole

    check_ending(out, ".md")
    check_folder(out)
    if not (episodes or scenarios):
        raise InvalidInputError("--episodes 0 leaves nothing to fly; give --scenarios, too, or more episodes")
    team = requested_team(processes, distributed=distributed, address=address)
    policies = policies_of(requested_policies(policy or []))
    agents = [str(one) for one in agent or ([] if policies else [Baseline.CONTROLLER])]
    tasks = task or list(dict.fromkeys(one.task for one in policies if not agents))
    wanted: list[Entry] = []
    if episodes:
        wanted += entries(tasks, vehicle or [], level or ["medium"], agents, policies, perturb or [])
    if scenarios:
        wanted += scenario_entries(tasks, vehicle or [], agents, policies)
    plan = Plan(episodes, seed)
    kept = Kept(out.with_suffix(".json"), plan, fresh=fresh)
    with Progress(console=console, transient=True) as bar:
        missing = kept.missing(wanted, {one.name: one for one in policies})
        flying = bar.add_task("flying", total=len(missing))

        def after(result: Result) -> None:
            what = result.entry.scenario or result.entry.vehicle
            bar.update(flying, advance=1, description=f"{result.entry.task}, {what}")

        try:
            results = fly_all(wanted, plan, kept, team=team, after=after, policies=policies)
        except KeyboardInterrupt:
            bar.stop()
            console.print(f"Stopped; {len(kept.results)} results are kept in {kept.path}", soft_wrap=True)
            raise typer.Exit(130) from None
    options = {
        "task": task,
        "vehicle": vehicle,
        "level": level,
        "perturb": perturb,
        "agent": agents,
        "policy": policy,
    }
    flags = ["--scenarios"] if scenarios else []
    write_whole(out, markdown(results, _command(options, flags, plan), _circumstances()))
    console.print(f"Wrote {out} and {kept.path}", soft_wrap=True)


def _command(options: Mapping[str, Sequence[object] | None], flags: list[str], plan: object) -> str:
    """Return what makes the page again."""
    parts = ["dq-marine", "leaderboard"]
    for name, values in options.items():
        for value in values or ():
            parts += [f"--{name}", str(value)]
    parts += flags
    for name, number in vars(plan).items():
        parts += [f"--{name}", str(number)]
    return shlex.join(parts)


def _circumstances() -> str:
    """Return what was measured with."""
    from dq_marine.report.machine import commit, cpu_model, versions

    at = commit("dq_marine", "envs", "agents")
    libraries = ", ".join(f"{name} {number}" for name, number in versions(("numpy", "numba")).items())
    return f"Measured on {cpu_model()}, {libraries}{f', commit {at}' if at else ''}."
