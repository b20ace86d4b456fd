"""The replays that pages show: each is a scenario, flown by the baseline controller."""

from __future__ import annotations

import re
from pathlib import Path

REPLAY = re.compile(r"replays/(\w+/\w+)\.html")


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
