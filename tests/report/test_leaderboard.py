"""The leaderboard: what is flown, how often it succeeds, and that what was flown is kept."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.cli.main import app
from dq_marine.envs.core.registry import shipped_tasks
from dq_marine.envs.scenarios.environment import make_scenario
from dq_marine.envs.scenarios.files import load_scenario, scenarios_of
from dq_marine.errors import InvalidInputError
from dq_marine.report.interquartile import Interval
from dq_marine.report.leaderboard import (
    Entry,
    Kept,
    Plan,
    Result,
    entries,
    environment_of,
    fly_all,
    fly_entry,
    scenario_entries,
)
from dq_marine.report.leaderboard_page import markdown
from dq_marine.report.leaderboard_policies import Policy
from dq_marine.util.side_by_side import team_here

STATION_KEEPING = "dq_marine/StationKeeping-v0"
ENTRY = Entry(STATION_KEEPING, "bluerov2_heavy", "medium", "controller")
PLAN = Plan(3, 5)


def test_every_task_is_flown_with_every_vehicle_that_it_suits():
    found = entries([], [], ["medium"], ["controller"])
    assert {one.task for one in found} == {one.id for one in shipped_tasks()}
    assert ENTRY in found
    assert not any(one.task == STATION_KEEPING and one.vehicle == "remus100" for one in found)
    assert len(set(found)) == len(found)


def test_agents_with_a_model_fly_where_they_can():
    found = entries(["TrajectoryTracking"], ["bluerov2", "otter"], ["medium"], ["controller", "lqr", "mpc"])
    assert [(one.vehicle, one.agent) for one in found] == [
        ("bluerov2", "controller"),
        ("bluerov2", "lqr"),
        ("bluerov2", "mpc"),
        ("otter", "controller"),
    ]
    flown = scenario_entries(["StationKeeping", "TrajectoryTracking"], [], ["lqr"])
    assert {one.task for one in flown} == {"dq_marine/TrajectoryTracking-v0"}
    with pytest.raises(InvalidInputError, match=r"the agents \['lqr'\] can fly; give others"):
        scenario_entries(["Docking"], [], ["lqr"])


@pytest.mark.sweep  # it makes environments of several vehicles
def test_perturbed_entries_stand_beside_those_that_go_as_planned_where_the_vehicle_can_have_them():
    perturbations = ["late_actions", "lost_thruster"]
    found = entries(
        ["DepthHeading"], ["remus100", "bluerov2"], ["easy"], ["controller"], perturbations=perturbations
    )
    assert [(one.vehicle, one.perturbation) for one in found] == [
        ("remus100", ""),
        ("remus100", "late_actions"),
        ("bluerov2", ""),
        ("bluerov2", "late_actions"),
        ("bluerov2", "lost_thruster"),
    ]
    assert environment_of(found[1]).keywords["perturb"] == "late_actions"
    assert "perturb" not in environment_of(found[0]).keywords
    with pytest.raises(InvalidInputError, match="perturb = 'storm' is unknown"):
        entries([], [], ["easy"], ["controller"], perturbations=["storm"])


def test_the_page_says_what_was_perturbed():
    error = {"position_error_m": Interval(0.125, 0.1, 0.15)}
    results = [
        result_of(ENTRY, 20, 20, **error),
        result_of(ENTRY._replace(perturbation="payload"), 7, 20, **error),
    ]
    page = markdown(results, "dq-marine leaderboard", "Measured.")
    assert "| vehicle | level | perturbed by | agent | success |" in page
    assert "| bluerov2_heavy | medium | nothing | controller | 20 of 20" in page
    assert "| bluerov2_heavy | medium | payload | controller | 7 of 20" in page


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ((["NoSuch"], [], ["medium"], ["controller"]), "there is no task"),
        (([], ["titanic"], ["medium"], ["controller"]), "titanic"),
        (([], [], ["brutal"], ["controller"]), "level = 'brutal' is unknown"),
        ((["StationKeeping"], ["remus100"], ["medium"], ["controller"]), "suits any of the vehicles"),
    ],
)
def test_what_there_is_not_is_refused(asked, message):
    with pytest.raises(InvalidInputError, match=message):
        entries(*asked)


def test_a_result_is_what_evaluation_says_and_is_not_flown_again(tmp_path):
    kept = Kept(tmp_path / "board.json", PLAN)
    new = []
    (result,) = fly_all([ENTRY], PLAN, kept, team=team_here(1), after=new.append)
    keywords = {"vehicle": ENTRY.vehicle, "level": ENTRY.level}
    env = make_environment(EnvironmentSettings(id=ENTRY.task, keywords=keywords))
    (score,) = evaluate(env, {"controller": make_baseline("controller", env)}, episodes=3, seed=5)
    assert result.score == json.loads(json.dumps(score.as_dict()))
    assert result.successes == round(3 * score.success_rate)
    assert new == [result]
    again = Kept(tmp_path / "board.json", PLAN)
    nobody = pytest.fail  # is asked to fly
    assert fly_all([ENTRY], PLAN, again, team=nobody, after=new.append) == [result]
    assert new == [result]
    assert Kept(tmp_path / "board.json", Plan(4, 5)).results == {}  # of another plan
    assert Kept(tmp_path / "board.json", PLAN, fresh=True).results == {}


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"episodes": 3, "seed": 5, "results": 7}', "\x00"])
def test_a_damaged_file_is_said_to_be_one_or_is_of_other_sources(tmp_path, content):
    path = tmp_path / "board.json"
    path.write_text(content)
    with pytest.raises(InvalidInputError, match=r"board\.json is no leaderboard: .* give --fresh"):
        Kept(path, PLAN)


def result_of(entry, successes, episodes, collision_rate=None, **figures):
    score = {"early_end_rate": 0.05, "collision_rate": collision_rate}
    actions = {"effort": Interval(0.01, 0.01, 0.02), "action_change": Interval(0.1, 0.1, 0.1)}
    return Result(entry, successes, episodes, score, {"return": Interval(1, 1, 1), **figures, **actions})


def test_the_page_has_a_table_a_task_with_intervals():
    error = {"position_error_m": Interval(0.125, 0.1, 0.15)}
    other = ENTRY._replace(task="dq_marine/Other-v0")
    results = [result_of(ENTRY, 19, 20, **error), result_of(other, 20, 20, 0.25, **error)]
    page = markdown(results, "dq-marine leaderboard", "Measured.")
    assert page.count("| vehicle | level | agent | success |") == 2
    assert "19 of 20 (76.4% to 99.1%)" in page  # Wilson's interval, as tables of it have it
    assert "| 0.125 (0.1 to 0.15) | 0.01 (0.01 to 0.02) | 0.1 (0.1 to 0.1) | 5.0% |" in page
    assert "| 0.1 (0.1 to 0.1) | 5 of 20 | 5.0% |" in page  # collisions, only of the task that measures them
    assert "Scenarios together" not in page


def test_the_page_sums_the_scenarios_up_and_lists_them():
    results = []
    for number, error in enumerate([0.0, 1.0, 2.0, 3.0, 100.0]):
        entry = ENTRY._replace(level="", scenario=f"number_{number}")
        results.append(result_of(entry, error < 3.0, 1, 0.0, error_m=Interval(error, error, error)))
    page = markdown(results, "dq-marine leaderboard --scenarios", "Measured.")
    assert "| controller | 3 of 5 (23.1% to 88.2%) | 2 (" in page  # of five, one is cut off at each end
    assert "| number_4 | bluerov2_heavy | controller | no | 100 | 0.01 | 0.1 | 0 of 1 |" in page
    assert "| number_0 | bluerov2_heavy | controller | yes | 0 |" in page


def test_every_scenario_that_ships_is_flown():
    found = scenario_entries([], [], ["controller", "zero"])
    assert len(found) == 2 * len(scenarios_of())
    assert len(set(found)) == len(found)
    of_one = scenario_entries(["StationKeeping"], ["rexrov"], ["zero"])
    assert {(one.task, one.vehicle) for one in of_one} == {(STATION_KEEPING, "rexrov")}
    with pytest.raises(InvalidInputError, match="no scenarios ship for"):
        scenario_entries(["StationKeeping"], ["remus100"], ["zero"])


def test_a_scenario_is_flown_as_it_is_named():
    """The drift of a vehicle that does nothing, from the scenario's start in the scenario's current."""
    entry = Entry(STATION_KEEPING, "bluerov2_heavy", "", "zero", "head_current")
    result = fly_entry(entry, PLAN)
    env = make_scenario(load_scenario("StationKeeping/head_current"))
    (score,) = evaluate(env, {"zero": make_baseline("zero", env)}, episodes=1, seed=0)
    assert result.score == score.as_dict()
    assert (result.episodes, result.figures["effort"]) == (1, Interval(0.0, 0.0, 0.0))
    steady = score.metrics["position_error"].steady.mean
    assert result.figures["position_error_m"] == pytest.approx((steady,) * 3)


def test_a_policy_flies_what_it_was_trained_for_and_fits():
    """It has no model here: what fits is told by task, vehicle and the shapes of the environments."""
    policy = Policy("mine", Path("runs/mine"), "0123", EnvironmentSettings(id=STATION_KEEPING))
    found = entries(["StationKeeping"], [], ["easy", "hard"], ["zero"], [policy])
    mine = [one for one in found if one.agent == "mine"]
    assert mine == [
        Entry(STATION_KEEPING, "bluerov2_heavy", "easy", "mine")
    ]  # "hard" shows sensors' ages, too
    names = {one.scenario for one in scenario_entries(["StationKeeping", "Docking"], [], [], [policy])}
    assert "calm" in names
    assert names.isdisjoint({"real_sensors", "thrusters", "no_pitch", "torpedo"})
    assert all(
        environment_of(one).id == STATION_KEEPING
        for one in scenario_entries(["StationKeeping"], [], [], [policy])
    )


def test_a_policy_commands_what_it_was_trained_to_command_unless_the_environment_says_otherwise():
    task = "dq_marine/DynamicPositioning-v0"
    own = EnvironmentSettings(id=task, keywords={"actuation": "wrench"})
    policy = Policy("mine", Path("runs/mine"), "0123", own)
    (mine,) = entries(["DynamicPositioning"], [], ["medium"], [], [policy])
    assert mine == Entry(task, "osv83", "medium", "mine")
    assert policy.flown_in(environment_of(mine)).keywords["actuation"] == "wrench"
    thrusters = EnvironmentSettings(id=task, keywords={"actuation": "thrusters"})
    assert policy.flown_in(thrusters) == thrusters
    assert not policy.fits(thrusters)


def test_results_of_another_model_of_a_policy_are_flown_again(tmp_path):
    kept, entry = Kept(tmp_path / "board.json", PLAN), ENTRY._replace(agent="mine")
    old = Result(entry, 1, 3, {}, {"effort": Interval(0.0, 0.0, 0.0)}, policy="old")
    kept.add(old)
    assert Kept(kept.path, PLAN).results == {entry: old}
    settings = EnvironmentSettings(id=STATION_KEEPING)
    for digest, missing in (("old", []), ("new", [entry])):
        policy = Policy("mine", Path("runs/mine"), digest, settings)
        assert kept.missing([entry], {"mine": policy}) == missing


def test_the_command_writes_page_and_figures(tmp_path):
    out = tmp_path / "board.md"
    options = [
        "--task",
        "StationKeeping",
        "--vehicle",
        "bluerov2_heavy",
        "--episodes",
        "1",
        "--out",
        str(out),
    ]
    result = CliRunner().invoke(app, ["leaderboard", *options], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    assert "1 of 1" in out.read_text()
    assert json.loads(out.with_suffix(".json").read_text())["episodes"] == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--out", "board.txt"], "ends in .md"),
        (["--out", "nowhere/board.md"], "does not exist"),
        (["--level", "x"], "x"),
        (["--episodes", "0"], "nothing to fly; give --scenarios"),
        (["--policy", "nowhere"], "holds no run"),
    ],
)
def test_the_command_refuses_before_it_flies(tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["leaderboard", *options])
    assert result.exit_code != 0
    assert message in result.output
    assert list(tmp_path.iterdir()) == []
