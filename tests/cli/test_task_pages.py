"""The pages of the tasks: those committed are what the code makes now, and they say all that a task declares."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path

import pytest
from support.command_line import assert_refused, run

from dq_marine.agents.evaluation.picture import scenario_picture
from dq_marine.cli.task_pages import (
    INDEX,
    documented,
    page_name,
    picture_name,
    shipped_tasks,
    task_page,
    task_pages,
)
from dq_marine.envs.core.registry import short_name, task_called
from dq_marine.envs.scenarios.files import load_scenario, scenarios_of
from dq_marine.report.interquartile import Interval
from dq_marine.report.leaderboard import Entry, Result

DOCS = Path(__file__).parents[2] / "docs"
PAGES = DOCS / "tasks"
REMEDY = "run `dq-marine tasks --pages docs/tasks` (with --pictures for a new task), look at it and commit it"
LARGEST_PICTURE = 60_000  # bytes


def test_the_committed_pages_are_what_the_code_makes_now():
    made = task_pages(DOCS / "leaderboard.json")
    committed = {path.name: path.read_text(encoding="utf-8") for path in PAGES.glob("*.md")}
    assert sorted(made) == sorted(committed), REMEDY
    assert [name for name in made if made[name] != committed[name]] == [], REMEDY


def test_a_page_has_its_picture_and_no_picture_is_left_over():
    wanted = {picture_name(task) for task in shipped_tasks() if scenarios_of(task.id)}
    assert {path.name for path in PAGES.glob("*.png")} == wanted, REMEDY


@pytest.mark.parametrize("picture", sorted(PAGES.glob("*.png")), ids=lambda path: path.stem)
def test_a_picture_is_small(picture):
    image = pytest.importorskip("PIL.Image").open(io.BytesIO(picture.read_bytes()))
    assert image.size == (640, 480)
    assert picture.stat().st_size <= LARGEST_PICTURE


@pytest.mark.parametrize("task", shipped_tasks(), ids=short_name)
def test_a_page_names_all_that_the_task_declares(task):
    page = task_page(task, [])
    named = set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE))
    declared = {*task.keywords, *task.metric_names, *task.weights._fields, *task.options, *task.levels}
    assert declared | {one.name for one in scenarios_of(task.id)} <= named
    assert task.id in page
    assert task.summary in page
    assert "What agents achieve" not in page


def test_the_index_leads_to_every_page():
    index = task_pages()[INDEX]
    assert re.findall(r"\]\((\w+\.md)\)", index) == [page_name(task) for task in shipped_tasks()]


def test_figures_of_the_leaderboard_stand_on_the_page_of_their_task(tmp_path):
    figures = {name: Interval(0.125, 0.1, 0.15) for name in ("return", "error_m", "effort", "action_change")}
    score = {"early_end_rate": 0.0, "collision_rate": None}
    entry = Entry("dq_marine/StationKeeping-v0", "bluerov2_heavy", "medium", "controller")
    results = [
        Result(entry, 19, 20, score, figures),
        Result(entry._replace(scenario="calm"), 1, 1, score, figures),
    ]
    rows = [{**vars(one), "entry": one.entry._asdict()} for one in results]
    path = tmp_path / "leaderboard.json"
    path.write_text(json.dumps({"results": rows}))
    pages = task_pages(path)
    assert "19 of 20 (76.4% to 99.1%) | 0.125 (0.1 to 0.15)" in pages["StationKeeping.md"]
    assert "| controller | 1 of 1 (20.7% to 100.0%) | 0.125 (0.125 to 0.125)" in pages["StationKeeping.md"]
    assert "What agents achieve" not in pages["Docking.md"]


def test_a_docstring_becomes_paragraphs_and_a_list():
    def function():
        """Say what it is.

        And a second paragraph,
        in two lines.

        Attributes:
            one: the first
                of two.
            two: the second.
        """

    assert documented(function).split("\n\n") == [
        "Say what it is.",
        "And a second paragraph, in two lines.",
        "- `one`: the first of two.\n- `two`: the second.",
    ]


def test_the_command_writes_the_pages(tmp_path):
    result = run("tasks", "--pages", tmp_path / "docs" / "tasks")
    assert result.exit_code == 0, result.output
    found = {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "docs" / "tasks").iterdir()}
    assert found == task_pages()


def test_what_cannot_be_is_refused(tmp_path):
    assert_refused(run("tasks", "StationKeeping", "--pages", tmp_path), "leave StationKeeping out")
    assert_refused(run("tasks", "--pictures"), "give --pages FOLDER, too")
    (tmp_path / "leaderboard.json").write_text("[]")
    assert_refused(run("tasks", "--pages", tmp_path / "tasks"), "is no leaderboard")


@pytest.mark.sweep
@pytest.mark.browser
def test_a_picture_shows_the_scenario_under_way():
    """The vehicle, and not one colour alone."""
    file = scenario_picture(load_scenario("StationKeeping/head_current"))
    assert len(file) <= LARGEST_PICTURE
    image = pytest.importorskip("PIL.Image").open(io.BytesIO(file))
    assert (image.format, image.size) == ("PNG", (640, 480))
    assert len(image.convert("RGB").getcolors(256)) > 20


def test_the_default_action_of_a_task_by_thrusters_is_that_of_its_channels():
    page = task_page(task_called("DynamicPositioning"), [])
    assert "| forward bow tunnel | 1 | -1 | 1 |" in page
