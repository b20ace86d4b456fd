"""The leaderboard: what is flown, how often it succeeds, and that what was flown is kept."""

import json

import pytest
from typer.testing import CliRunner

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.cli.main import app
from dq_marine.envs.core.registry import registered_tasks
from dq_marine.errors import InvalidInputError
from dq_marine.report.leaderboard import Entry, Kept, Plan, Result, entries, fly_all, markdown

STATION_KEEPING = "dq_marine/StationKeeping-v0"
ENTRY = Entry(STATION_KEEPING, "bluerov2_heavy", "medium", "controller")
PLAN = Plan(3, 5)


def test_every_task_is_flown_with_every_vehicle_that_it_suits():
    found = entries([], [], ["medium"], ["controller"])
    assert {one.task for one in found} == {
        one.id for one in registered_tasks() if one.id.startswith("dq_marine/")
    }
    assert ENTRY in found
    assert not any(one.task == STATION_KEEPING and one.vehicle == "remus100" for one in found)
    assert len(set(found)) == len(found)


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
    (result,) = fly_all([ENTRY], PLAN, kept, processes=1, after=new.append)
    keywords = {"vehicle": ENTRY.vehicle, "level": ENTRY.level}
    env = make_environment(EnvironmentSettings(id=ENTRY.task, keywords=keywords))
    (score,) = evaluate(env, {"controller": make_baseline("controller", env)}, episodes=3, seed=5)
    assert result.score == json.loads(json.dumps(score.as_dict()))
    assert result.successes == round(3 * score.success_rate)
    assert new == [result]
    again = Kept(tmp_path / "board.json", PLAN)
    assert fly_all([ENTRY], PLAN, again, processes=1, after=new.append) == [result]
    assert new == [result]
    assert Kept(tmp_path / "board.json", Plan(4, 5)).results == {}  # of another plan
    assert Kept(tmp_path / "board.json", PLAN, fresh=True).results == {}


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"episodes": 3, "seed": 5, "results": 7}', "\x00"])
def test_a_damaged_file_is_said_to_be_one_or_is_of_other_sources(tmp_path, content):
    path = tmp_path / "board.json"
    path.write_text(content)
    with pytest.raises(InvalidInputError, match=r"board\.json is no leaderboard: .* give --fresh"):
        Kept(path, PLAN)


def test_the_page_has_a_table_a_task_with_intervals():
    metrics = {"position_error_m": {"final": {}, "steady": {"mean": 0.2, "median": 0.125, "p95": 1.0}}}
    score = {"metrics": metrics, "early_end_rate": 0.05}
    other = ENTRY._replace(task="dq_marine/Other-v0")
    page = markdown(
        [Result(ENTRY, 19, 20, score), Result(other, 20, 20, score)], "dq-marine leaderboard", "Measured."
    )
    assert page.count("| vehicle | level | agent | success |") == 2
    assert "19 of 20 (76.4% to 99.1%)" in page  # Wilson's interval, as tables of it have it
    assert "| 0.125 | 5.0% |" in page


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
    ],
)
def test_the_command_refuses_before_it_flies(tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["leaderboard", *options])
    assert result.exit_code != 0
    assert message in result.output
    assert list(tmp_path.iterdir()) == []
