"""The replays that pages show: scenarios, flown by the baseline controller, and comparisons."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

REPLAY = re.compile(r"replays/(\w+/\w+)\.html")
COMPARISON = re.compile(r"dq-marine compare ([^\n]*)--html (\w+)\.html")


def shown_in(page: str) -> set[str]:
    """Return the scenarios whose replays a page links to, as `StationKeeping/cross_current`."""
    return set(REPLAY.findall(page))


def write_replay(name: str, file: Path) -> None:
    """Fly a scenario as `dq-marine fly --scenario NAME --html FILE` does."""
    from dq_marine.agents.controllers.baselines import controller_for
    from dq_marine.agents.environments import scenario_settings
    from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, fly
    from dq_marine.envs.scenarios.files import load_scenario

    scenario = load_scenario(name)
    plan = FlightPlan(scenario_settings(scenario), None, scenario.seed, start=scenario.reset)
    fly(plan, controller_for, Outputs(html=file), title=name)


def comparisons_in(page: str) -> dict[str, list[str]]:
    """Return the options of the comparisons that a page shows as `comparisons/NAME.html`, by that name.

    They stand on the page as `dq-marine compare OPTIONS --html NAME.html`.
    """
    commands = {name: shlex.split(options) for options, name in COMPARISON.findall(page)}
    return {name: options for name, options in commands.items() if f"comparisons/{name}.html" in page}


def write_comparison(options: list[str], file: Path) -> None:
    """Write a page as `dq-marine compare OPTIONS --html FILE` does."""
    from dq_marine.cli.main import app

    app(["compare", *options, "--html", str(file)], standalone_mode=False)
