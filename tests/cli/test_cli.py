"""The command line: helpful, light to import, and clear about what is wrong."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.command_line import assert_refused, run

from dq_marine import __version__
from dq_marine.vehicles import vehicle_names

COMMANDS = [
    ["demo"],
    ["fly"],
    ["evaluate"],
    ["train"],
    ["export"],
    ["share"],
    ["leaderboard"],
    ["record"],
    ["report"],
    ["sea"],
    ["manoeuvre"],
    ["manoeuvre", "bluerov2", "zig-zag"],
    ["vehicles"],
    ["vehicles", "check"],
    ["vehicles", "sheet"],
    ["vehicles", "show"],
    ["vehicles", "export"],
    ["vehicles", "randomise"],
]


def python(code: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "COLUMNS": "200"}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


def test_help_lists_the_commands() -> None:
    for arguments in (["--help"], ["-h"], []):
        output = run(*arguments).output
        for command in ("demo", "fly", "evaluate", "train", "export", "share", "vehicles"):
            assert command in output


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_has_an_example(command: list[str]) -> None:
    result = run(*command, "--help")
    assert result.exit_code == 0
    assert "Examples:" in result.output
    assert f"dq-marine {command[0]}" in result.output


def test_version() -> None:
    assert run("--version").output == f"dq-marine {__version__}\n"


def test_help_is_light() -> None:
    """Nothing that learns, compiles or draws is imported before a command asks for it."""
    heavy = ["torch", "stable_baselines3", "numba", "matplotlib", "meshcat", "dq_marine.viewer", "scipy"]
    result = python(
        f"import sys, dq_marine.cli.main; print([name for name in {heavy} if name in sys.modules])"
    )
    assert result.stdout == "[]\n", result.stdout + result.stderr


@pytest.mark.parametrize(
    ("missing", "command"),
    [
        (["torch", "stable_baselines3"], "train --run runs/ppo"),
        (["matplotlib"], "fly --plot errors.png --seconds 0.1"),
    ],
)
def test_a_missing_extra_is_named(tmp_path: Path, missing: list[str], command: str) -> None:
    code = (
        f"import os, sys; os.chdir({str(tmp_path)!r}); sys.modules.update(dict.fromkeys({missing}));"
        f"from dq_marine.cli.main import app; app({command.split()})"
    )
    result = python(code)
    assert result.returncode == 1
    assert re.search(
        rf"Error: \w+ needs '(?:{'|'.join(missing)}).*pip install \"dq-marine\[agents\]\"", result.stderr
    ), result.stderr
    assert not list(tmp_path.iterdir())


def test_vehicles_are_listed() -> None:
    result = run("vehicles")
    assert result.exit_code == 0
    for name in vehicle_names():
        assert name in result.output


def test_a_vehicle_file_is_checked(tmp_path: Path) -> None:
    source = Path(__file__).parents[2] / "dq_marine" / "vehicles" / "catalogue" / "bluerov2_heavy.toml"
    mine = tmp_path / "mine.toml"
    mine.write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
    result = run("vehicles", "check", mine)
    assert result.exit_code == 0
    assert "is valid: BlueROV2 Heavy" in result.output
    assert "natural period of roll, pitch" in result.output
    assert json.loads(run("vehicles", "check", mine, "--json").stdout)["dry_mass"] == 13.5
    mine.write_text(
        source.read_text(encoding="utf-8").replace("mass = 13.5", "mass = -13.5"), encoding="utf-8"
    )
    assert_refused(run("vehicles", "check", mine), r"mine\.toml is refused:\n  rigid_body\.mass = -13\.5")


def test_the_list_has_key_numbers_and_fits_a_terminal() -> None:
    """A name or a number that does not fit would end in an ellipsis."""
    output = run("vehicles").output
    assert "\u2026" not in output
    assert re.search(r"npsauv .* X---MN .* 7\.11, 24\.5", output)


@pytest.mark.parametrize("name", vehicle_names())
def test_a_sheet_is_printed(name: str) -> None:
    result = run("vehicles", "sheet", name)
    assert result.exit_code == 0, result.output
    for row in (
        "dry mass",
        "added mass in yaw",
        "terminal speed in surge",
        "Munk growth rate at 1 m/s ahead",
    ):
        assert row in result.output
    content = json.loads(run("vehicles", "sheet", name, "--speed", "2", "--json").stdout)
    assert content["speed"] == 2.0
    assert set(content["terminal_speed"]) == {"surge", "sway", "heave", "roll", "pitch", "yaw"}


def test_a_vehicle_is_shown_in_a_page(tmp_path: Path) -> None:
    page = tmp_path / "rexrov.html"
    result = run("vehicles", "show", "rexrov", "--html", page)
    assert result.exit_code == 0, result.output
    assert "RexROV" in page.read_text(encoding="utf-8")


def test_a_vehicle_is_shown_live(monkeypatch: pytest.MonkeyPatch) -> None:
    """The page is up until Ctrl-C, and its server ends with the command."""
    from dq_marine.cli import vehicles

    waited = []
    monkeypatch.setattr(vehicles, "wait_for_interrupt", lambda: waited.append(True))
    monkeypatch.setattr("dq_marine.viewer.live.display_present", lambda: False)
    result = run("vehicles", "show", "bluerov2")
    assert result.exit_code == 0, result.output
    assert "Ctrl-C" in result.output
    assert waited == [True]


def test_a_vehicle_is_exported_and_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = run("vehicles", "export", "rexrov")
    assert result.exit_code == 0, result.output
    assert "Wrote my_rexrov.toml" in result.output
    assert "is valid: My RexROV" in run("vehicles", "check", "my_rexrov.toml").output
    assert_refused(run("vehicles", "export", "rexrov"), r"my_rexrov\.toml exists; .*--force")
    assert run("vehicles", "export", "rexrov", "--force").exit_code == 0


def test_python_runs_the_package_as_the_command() -> None:
    result = subprocess.run([sys.executable, "-m", "dq_marine", "--version"], capture_output=True, text=True)
    assert result.stdout == f"dq-marine {__version__}\n", result.stderr


@pytest.mark.parametrize(
    ("arguments", "pattern"),
    [
        ("fly --agent zero --run runs/ppo", r"--agent zero and --run runs/ppo name two agents; give one"),
        (
            "fly --current east --plot x.png",
            r"--current east is neither a speed nor three components; give 0\.3 or",
        ),
        ("fly --current 0.1,0.2 --plot x.png", r"--current 0\.1,0\.2 is neither"),
        ("fly --vehicle titanic --plot x.png", r"no vehicle 'titanic'; the catalogue holds .*bluerov2_heavy"),
        ("fly --seconds -3 --plot x.png", r"seconds = -3; give"),
        ("fly --run nowhere --plot x.png", r"nowhere holds no run"),
        ("fly --set depth=3", r"no keyword 'depth'; it takes action_delay, actuation, .*weather"),
        ("fly --set vehicle=otter --vehicle otter", r"--vehicle otter and --set vehicle=\.\.\. both say it"),
        ("fly --set goal_position=[0,", r"--set goal_position=\[0,: the value is neither TOML nor JSON"),
        ("fly --run nowhere --preset ppo", r"--preset ppo and --run nowhere both say what to fly in"),
        ("fly --task Nothing-v0", r"environment id = 'Nothing-v0'.*There are .*dq_marine/StationKeeping-v0"),
        (
            "fly --trajectory x.xlsx",
            r"x\.xlsx has no ending that trajectories have; give one of \.csv, \.parquet",
        ),
        ("evaluate --set reward.effrot=1", r"reward has unknown keys \['effrot'\]"),
        ("train --print-preset --set depth=3", r"no keyword 'depth'"),
        ("evaluate --run nowhere", r"nowhere holds no run"),
        ("evaluate --current -0.5", r"current = -0\.5; give at least 0"),
        ("vehicles check nowhere.toml", r"no file 'nowhere\.toml'"),
        ("vehicles sheet titanic", r"no vehicle 'titanic'"),
        ("vehicles sheet rexrov --speed 0", r"speed = 0 is not finite and above 0"),
        ("vehicles show rexrov --html nowhere/x.html", r"the folder nowhere does not exist"),
        ("train --run x --preset nothing", r"no preset or file 'nothing'; the presets are"),
        ("train --run x --preset sac --algorithm ppo", r"--algorithm ppo does not go with --preset sac"),
        ("train --run x --preset dp_controller", r"is refused:\n  timesteps: missing"),
        ("train --run x --vehicle titanic", r"no vehicle 'titanic'"),
        ("train --run x --resume", r"x holds no run"),
        ("train --run x --resume --seed 3 --force", r"--seed, --force cannot go with --resume"),
        ("train --run x --resume --set current=1", r"--set cannot go with --resume"),
        (
            "train --run x --resume --privileged-critic current",
            r"--privileged-critic cannot go with --resume",
        ),
        ("train --run x --privileged-critic thrust", r"privileged_critic\.0 = 'thrust'"),
        (
            "train --run x --algorithm crossq --privileged-critic current",
            r"crossq.* takes no observations in parts",
        ),
        ("vehicles export titanic", r"no vehicle 'titanic' in the catalogue"),
    ],
)
def test_mistakes_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: str, pattern: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert_refused(run(*arguments.split()), pattern)
    assert not list(tmp_path.iterdir())


def test_values_out_of_range_show_the_usage() -> None:
    result = run("evaluate", "--episodes", "0")
    assert result.exit_code == 2
    assert "--episodes" in result.output


def test_drawn_vehicles_are_summed_up(tmp_path: Path) -> None:
    result = run("vehicles", "randomise", "rexrov", "--samples", "20", "--seed", "1")
    assert result.exit_code == 0, result.output
    for row in ("mass", "weight less buoyancy", "natural period of roll", "terminal speed in yaw"):
        assert row in result.output
    mine = tmp_path / "mine.toml"
    mine.write_text("[rigid_body]\nmass = { uniform = [1.1, 1.1] }\n", encoding="utf-8")
    content = json.loads(run("vehicles", "randomise", "remus100", "--file", mine, "--json").stdout)
    mass = content[0]
    assert (mass["name"], mass["unit"], mass["nominal"]) == ("mass", "kg", 30.48)
    assert mass["least"] == mass["largest"] == pytest.approx(1.1 * 30.48)
    mine.write_text("[rigid_body]\nmass = 1.1\n", encoding="utf-8")
    assert_refused(
        run("vehicles", "randomise", "remus100", "--file", mine), r"rigid_body\.mass = 1\.1: not a distrib"
    )
