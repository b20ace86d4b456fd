"""The command `dq-marine leaderboard`: every task with every vehicle, over many episodes."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, examples
from dq_marine.cli.options import Baseline

EXAMPLES = examples(
    "dq-marine leaderboard",
    "dq-marine leaderboard --task StationKeeping --episodes 20",
    "dq-marine leaderboard --vehicle remus100 --vehicle otter --level easy --level hard",
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
    agent: Annotated[
        list[Baseline] | None,
        typer.Option("--agent", help="A baseline; may be repeated.", show_default="controller"),
    ] = None,
    episodes: Annotated[int, typer.Option("--episodes", min=1, help="Number of episodes of each.")] = 200,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Seed of the first episode; the others count up from it.")
    ] = 0,
    processes: Annotated[
        int | None,
        typer.Option("--processes", min=1, max=256, help="That fly at a time.", show_default="all cores"),
    ] = None,
    out: Annotated[
        Path, typer.Option("--out", help="The page; its figures are kept beside it, as .json.")
    ] = Path("leaderboard.md"),
    fresh: Annotated[bool, typer.Option("--fresh", help="Measure again what was measured before.")] = False,
) -> None:
    """Fly every task with every vehicle that it suits, and write how often agents succeed.

    Results are kept as they come: a run that was stopped goes on where it was, unless the sources have changed.
    """
    from rich.progress import Progress

    from dq_marine.backend.workers import usable_cores
    from dq_marine.report.leaderboard import Kept, Plan, Result, entries, fly_all, markdown
    from dq_marine.util.files import check_ending, check_folder, write_whole

    check_ending(out, ".md")
    check_folder(out)
    agents = [str(one) for one in agent or [Baseline.CONTROLLER]]
    wanted = entries(task or [], vehicle or [], level or ["medium"], agents)
    plan = Plan(episodes, seed)
    kept = Kept(out.with_suffix(".json"), plan, fresh=fresh)
    with Progress(console=console, transient=True) as bar:
        missing = [entry for entry in wanted if entry not in kept.results]
        flying = bar.add_task("flying", total=len(missing))

        def after(result: Result) -> None:
            bar.update(flying, advance=1, description=f"{result.entry.task}, {result.entry.vehicle}")

        try:
            results = fly_all(wanted, plan, kept, processes=processes or usable_cores(), after=after)
        except KeyboardInterrupt:
            bar.stop()
            console.print(f"Stopped; {len(kept.results)} results are kept in {kept.path}", soft_wrap=True)
            raise typer.Exit(130) from None
    write_whole(out, markdown(results, _command(task, vehicle, level, agents, plan), _circumstances()))
    console.print(f"Wrote {out} and {kept.path}", soft_wrap=True)


def _command(
    task: list[str] | None,
    vehicle: list[str] | None,
    level: list[str] | None,
    agents: list[str],
    plan: object,
) -> str:
    """Return what makes the page again."""
    parts = ["dq-marine", "leaderboard"]
    for name, values in (("task", task), ("vehicle", vehicle), ("level", level), ("agent", agents)):
        for value in values or ():
            parts += [f"--{name}", value]
    for name, number in vars(plan).items():
        parts += [f"--{name}", str(number)]
    return shlex.join(parts)


def _circumstances() -> str:
    """Return what was measured with."""
    from dq_marine.report.machine import commit, cpu_model, versions

    at = commit("dq_marine", "envs", "agents")
    libraries = ", ".join(f"{name} {number}" for name, number in versions(("numpy", "numba")).items())
    return f"Measured on {cpu_model()}, {libraries}{f', commit {at}' if at else ''}."
