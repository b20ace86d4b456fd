"""`dq-marine tasks`, and the README's tables, which are this command's."""

import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from support.command_line import assert_refused, run

from dq_marine.envs.core.registry import shipped_tasks
from dq_marine.simulation.settings import Settings

README = (Path(__file__).parents[2] / "README.md").read_text()


def marked(start, end):
    """The part of the README between two comments."""
    return README.split(f"<!-- {start} -->")[1].split(f"<!-- {end} -->")[0].strip()


def test_the_readme_has_the_table_of_tasks():
    """In a process of its own, which knows only the tasks of the package."""
    command = [sys.executable, "-m", "dq_marine", "tasks", "--markdown"]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stdout.strip() == marked("table of tasks", "end of the table of tasks")


def test_the_readme_has_the_observation_of_station_keeping():
    result = run("tasks", "StationKeeping", "--markdown")
    assert result.exit_code == 0, result.output
    table = marked("observation table: StationKeeping", "end of the observation table")
    assert table.startswith("| name |")
    assert f"**observation**\n\n{table}\n" in result.stdout


@pytest.mark.parametrize("task", shipped_tasks(), ids=lambda task: task.id)
def test_a_task_is_described_by_id_or_name(task):
    name = re.fullmatch(r"dq_marine/(\w+)-v0", task.id)[1]
    by_id, by_name = run("tasks", task.id, "--markdown"), run("tasks", name, "--markdown")
    assert by_id.exit_code == 0, by_id.output
    assert by_id.stdout == by_name.stdout
    named = (*task.metric_names, *task.weights._fields, *task.keywords)
    assert [one for one in named if f"| `{one}` |" not in by_id.stdout] == []
    assert run("tasks", name).exit_code == 0


def test_an_unknown_task_is_refused_with_the_known_ones():
    assert_refused(run("tasks", "Sailing"), "'Sailing'.*StationKeeping-v0")


def test_the_readme_names_every_setting():
    """And no keyword of a task, which the task's page has."""
    table = README.split("### Settings")[1].split("```python")[0]
    rows = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    named = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    known = {one.name for one in fields(Settings)}
    known |= {
        "level",
        "perturb",
        "reward",
        "extra_rewards",
        "settings",
        "observation",
        "privileged",
        "render_mode",
        "record",
    }
    assert named == known
