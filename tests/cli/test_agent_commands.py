"""The commands `fly`, `evaluate` and `train`: what they write, print and say."""

from __future__ import annotations

import csv
import json
import re
import tomllib
from pathlib import Path

import pytest
from support.command_line import assert_refused, run


def test_evaluation_is_written(tmp_path: Path) -> None:
    scores = tmp_path / "scores.json"
    result = run(
        "evaluate",
        "--agent",
        "zero",
        "--agent",
        "controller",
        "--episodes",
        "2",
        "--current",
        "0.1,0,0",
        "--json",
        scores,
    )
    assert result.exit_code == 0, result.output
    content = json.loads(scores.read_text())
    assert [score["agent"] for score in content["scores"]] == ["zero", "controller"]
    assert content["environment"]["keywords"] == {"current": [0.1, 0.0, 0.0]}
    assert content["scores"][1]["success_rate"] == 1.0


def test_model_based_agents_are_chosen_by_name_where_they_can_fly(tmp_path: Path) -> None:
    scores = tmp_path / "scores.json"
    agents = ("--agent", "lqr", "--agent", "mpc")
    task = ("--task", "TrajectoryTracking", "--episodes", "1", "--set", "max_episode_steps=30")
    result = run("evaluate", *task, *agents, "--json", scores)
    assert result.exit_code == 0, result.output
    assert [score["agent"] for score in json.loads(scores.read_text())["scores"]] == ["lqr", "mpc"]
    assert_refused(run("fly", "--agent", "mpc", "--seconds", "1"), "does not show goal_velocity_body")


def test_flight_is_written(tmp_path: Path) -> None:
    plot = tmp_path / "errors.png"
    result = run(
        "fly",
        "--agent",
        "zero",
        "--plot",
        plot,
        "--seconds",
        "1",
        "--start-distance",
        "1.5",
        "--current",
        "0.2",
    )
    assert result.exit_code == 0, result.output
    assert plot.is_file()
    assert "1.500 m" in result.output


@pytest.mark.browser
def test_a_video_is_written(tmp_path: Path) -> None:
    video = tmp_path / "flight.mp4"
    result = run(
        "fly", "--agent", "zero", "--mp4", video, "--fps", "5", "--seconds", "0.4", "--current", "0.2"
    )
    assert result.exit_code == 0, result.output
    assert f"Wrote {video}" in result.output.replace("\n", "")
    assert video.read_bytes()[4:8] == b"ftyp"  # ISO 14496-12, which MP4 is
    assert_refused(run("fly", "--fps", "5"), "--mp4")


def test_trajectories_are_written(tmp_path: Path) -> None:
    flight = tmp_path / "flight.csv"
    result = run("fly", "--trajectory", flight, "--seconds", "0.5", "--set", "current=[0.2,0,0]")
    assert result.exit_code == 0, result.output
    seed = re.search(r"seed\s+│\s+(\d+)", result.output)
    assert seed is not None
    assert int(seed[1]) > 0  # seed 0 begins at the goal
    with flight.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time_s"]) for row in rows] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    assert "action_surge" in rows[0]
    assert float(rows[0]["position_error_m"]) >= 1.0
    folder = tmp_path / "new" / "flights"
    arguments = [
        "evaluate",
        "--agent",
        "zero",
        "--episodes",
        "2",
        "--seed",
        "3",
        "--set",
        "max_episode_steps=5",
    ]
    result = run(*arguments, "--trajectories", folder)
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in folder.iterdir()) == ["zero_3.csv", "zero_4.csv"]
    assert len((folder / "zero_3.csv").read_text(encoding="utf-8").splitlines()) == 7


def test_a_printed_preset_is_read_back(tmp_path: Path) -> None:
    changes = ["--set", "current=[0.1,0,0]", "--set", "reward.effort=0.05", "--vehicle", "rexrov"]
    printed = run("train", "--print-preset", "--algorithm", "sac", "--timesteps", "9000", *changes)
    assert printed.exit_code == 0, printed.output
    mine = tmp_path / "mine.toml"
    mine.write_text(printed.stdout, encoding="utf-8")
    assert run("train", "--print-preset", "--preset", mine).stdout == printed.stdout
    content = tomllib.loads(printed.stdout)
    assert content["timesteps"] == 9000
    assert content["environment"]["keywords"] == {
        "vehicle": "rexrov",
        "current": [0.1, 0, 0],
        "reward": {"effort": 0.05},
    }
    for command in ("fly", "evaluate"):
        shown = tomllib.loads(run(command, "--preset", mine, "--print-preset", "--set", "reward=null").stdout)
        assert shown["environment"]["keywords"] == {"vehicle": "rexrov", "current": [0.1, 0, 0]}
    assert list(tmp_path.iterdir()) == [mine]


def test_a_vehicle_in_the_folder_of_nobody_is_refused(tmp_path: Path) -> None:
    """It was a RuntimeError: there is no home directory of this user."""
    result = run("fly", "--vehicle", "~nobody-of-this-name/rov.toml", "--html", tmp_path / "flight.html")
    assert_refused(result, "~nobody-of-this-name/rov.toml' is no path of a file")


def test_training_needs_a_folder() -> None:
    result = run("train")
    assert result.exit_code == 2
    assert "--run" in result.output


def test_training_from_the_command_line(tmp_path: Path) -> None:
    """Begun, refused a second time, resumed, evaluated."""
    arguments = ["train", "--run", tmp_path / "run", "--envs", "2", "--timesteps", "256"]
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    assert "mean return" in result.output
    assert_refused(run(*arguments), "holds a run already; continue it with --resume")
    assert run("train", "--run", tmp_path / "run", "--resume", "--timesteps", "512").exit_code == 0
    result = run("evaluate", "--run", tmp_path / "run", "--episodes", "1")
    assert result.exit_code == 0, result.output
    result = run("compare", "--run", tmp_path / "run", "--seconds", "1", "--html", tmp_path / "both.html")
    assert result.exit_code == 0, result.output
    assert re.search(r"controller\s+┃\s+run", result.output)
    assert "other conditions" not in result.output
    scores = tmp_path / "scores.json"
    changed = ["--set", "current=0.5", "--set", "substeps=2", "--json", scores]
    result = run("evaluate", "--run", tmp_path / "run", "--episodes", "1", *changed)
    assert result.exit_code == 0, result.output
    said = " ".join(result.output.split())
    assert (
        "run was trained under other conditions: current = 0.3, here 0.5, substeps = the default, here 2"
        in said
    )
    content = json.loads(scores.read_text())
    assert content["other_conditions"]["run"]["current"] == {"trained": 0.3, "here": 0.5}
    printed = run("train", "--run", tmp_path / "run", "--resume", "--print-preset").stdout
    assert tomllib.loads(printed)["timesteps"] == 512


def test_interrupted_training_says_how_to_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dq_marine.agents.training import training

    def interrupted(*arguments: object, **keywords: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(training, "begin_training", interrupted)
    result = run("train", "--run", tmp_path / "run")
    assert result.exit_code == 130
    assert re.search(r"Go on: dq-marine train --run .*run --resume", result.output)
