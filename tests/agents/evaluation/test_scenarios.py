"""Agents in scenarios, from Python and from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from support.command_line import assert_refused, run

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import scenario_settings
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.evaluation.scenarios import chosen_scenarios, evaluate_scenario
from dq_marine.envs.scenarios.environment import make_scenario
from dq_marine.envs.scenarios.files import load_scenario, scenarios_of
from dq_marine.errors import InvalidInputError

CALM = "StationKeeping/calm"


def test_a_task_stands_for_all_of_its_scenarios_and_none_is_chosen_twice() -> None:
    assert chosen_scenarios(["StationKeeping", CALM]) == list(scenarios_of("StationKeeping"))
    assert [one.name for one in chosen_scenarios(["calm"], task="Docking")] == ["calm"]
    with pytest.raises(
        InvalidInputError, match=r"Docking-v0 and dq_marine/StationKeeping-v0, which measure different"
    ):
        chosen_scenarios([CALM, "Docking/calm"])


def test_each_agent_flies_the_scenario_from_its_start() -> None:
    scenario = load_scenario(CALM)
    found = evaluate_scenario(
        scenario,
        scenario_settings(scenario),
        lambda env: {name: make_baseline(name, env) for name in ("zero", "controller")},
    )
    env = make_scenario(scenario)
    for score in found.scores:
        assert score == evaluate(env, {score.agent: make_baseline(score.agent, env)}, episodes=1, seed=0)[0]
    zero, controller = found.scores
    assert controller.success_rate == 1.0 > zero.success_rate
    assert controller.effort.mean > 0.0 == zero.effort.mean == zero.action_change.mean
    assert controller.collision_rate is None  # nothing to hit


def test_the_command_tells_of_one_scenario_or_of_several(tmp_path: Path) -> None:
    out = tmp_path / "scores.json"
    one = run("evaluate", "--scenario", CALM, "--agent", "zero", "--json", out)
    assert one.exit_code == 0, one.output
    assert "1 episodes each" in one.stdout
    (found,) = json.loads(out.read_text())
    assert (found["scenario"]["name"], found["seed"], len(found["scores"])) == ("calm", 0, 1)
    several = run(
        *("evaluate", "--scenario", CALM, "--scenario", "StationKeeping/turned_around"),
        *("--agent", "zero", "--trajectories", tmp_path / "flights", "--json", out),
    )
    assert several.exit_code == 0, several.output
    assert "turned_around" in several.stdout
    assert [one["scenario"]["name"] for one in json.loads(out.read_text())] == ["calm", "turned_around"]
    flights = sorted(path.name for path in (tmp_path / "flights").iterdir())
    assert flights == ["calm_zero_0.csv", "turned_around_zero_0.csv"]


def test_options_win_over_the_scenario(tmp_path: Path) -> None:
    out = tmp_path / "scores.json"
    options = ("--seed", "3", "--set", "max_episode_steps=4", "--json", out)
    assert run("evaluate", "--scenario", CALM, "--agent", "zero", *options).exit_code == 0
    (found,) = json.loads(out.read_text())
    assert found["seed"] == 3
    assert found["environment"]["keywords"] == {"current": [0.0, 0.0, 0.0], "max_episode_steps": 4}


def test_a_flight_begins_the_scenario_and_lasts_as_long(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    result = run("fly", "--scenario", CALM, "--agent", "zero", "--trajectory", path)
    assert result.exit_code == 0, result.output
    lines = path.read_text().splitlines()
    assert len(lines) == 302  # a heading, the start, and the 300 control periods of the task
    start = dict(zip(lines[0].split(","), map(float, lines[1].split(",")), strict=True))
    assert start["position_error_m"] == pytest.approx(1.5)
    short = run("fly", "--scenario", CALM, "--agent", "zero", "--trajectory", path, "--seconds", "2")
    assert short.exit_code == 0, short.output
    assert len(path.read_text().splitlines()) == 22


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("fly", "--scenario", "calm"), "may be any of"),
        (
            ("fly", "--scenario", CALM, "--preset", "ppo"),
            "--preset ppo and --scenario StationKeeping/calm both say",
        ),
        (("fly", "--scenario", CALM, "--start-distance", "1"), "--start-distance 1 and --scenario"),
        (
            ("fly", "--scenario", CALM, "--task", "Docking"),
            "is of dq_marine/StationKeeping-v0, not of 'Docking'",
        ),
        (("evaluate", "--scenario", "StationKeeping", "--print-preset"), "shows one environment, not 20"),
        (("scenarios", "Sailing"), "there is no scenario 'Sailing'"),
        (("scenarios", CALM, "--export", "calm.json"), "ends in .toml"),
        (("scenarios", "--export", "calm.toml"), "writes one scenario; name it"),
    ],
)
def test_what_cannot_be_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert_refused(run(*arguments), message)
    assert list(tmp_path.iterdir()) == []


def test_the_list_of_scenarios_leads_to_each(tmp_path: Path) -> None:
    tasks = run("scenarios", "--markdown").stdout
    assert "| `StationKeeping` | 20 | `calm`, " in tasks
    table = run("scenarios", "StationKeeping", "--markdown").stdout
    assert table.count("\n| `") == len(scenarios_of("StationKeeping"))
    assert run("scenarios", "StationKeeping").exit_code == 0
    text = run("scenarios", CALM).stdout
    file = tmp_path / "mine.toml"
    assert run("scenarios", CALM, "--export", file).exit_code == 0
    assert file.read_text() == text == load_scenario(CALM).toml
    assert_refused(run("scenarios", CALM, "--export", file), "--force")
    assert run("scenarios", CALM, "--export", file, "--force").exit_code == 0
    shown = run("evaluate", "--scenario", file, "--print-preset").stdout
    assert 'id = "dq_marine/StationKeeping-v0"' in shown
