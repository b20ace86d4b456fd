"""The command line: helpful, light to import, and clear about what is wrong."""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from dq_marine import __version__
from dq_marine.cli import app
from dq_marine.vehicles import vehicle_names

COMMANDS = [
    ["demo"],
    ["fly"],
    ["evaluate"],
    ["train"],
    ["report"],
    ["sea"],
    ["manoeuvre"],
    ["manoeuvre", "bluerov2", "zig-zag"],
    ["vehicles"],
    ["vehicles", "check"],
    ["vehicles", "sheet"],
    ["vehicles", "show"],
    ["vehicles", "randomise"],
]


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def python(code: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "COLUMNS": "200"}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


def assert_refused(result: Result, pattern: str) -> None:
    """One message on stderr, nothing on stdout, exit code 1, no traceback."""
    assert result.exit_code == 1, result.output
    assert result.stdout == ""
    assert re.match(rf"Error: .*{pattern}", result.stderr, re.DOTALL), result.stderr
    assert "Traceback" not in result.stderr


def test_help_lists_the_commands() -> None:
    for arguments in (["--help"], ["-h"], []):
        output = run(*arguments).output
        for command in ("demo", "fly", "evaluate", "train", "vehicles"):
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
    result = python(f"import sys, dq_marine.cli; print([name for name in {heavy} if name in sys.modules])")
    assert result.stdout == "[]\n", result.stdout + result.stderr


def test_help_is_quick() -> None:
    """In processor time, which a busy machine does not stretch."""

    def spent() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = spent()
    assert python("from dq_marine.cli import app; app(['--help'])").returncode == 0
    assert spent() - before < 0.6


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
        f"from dq_marine.cli import app; app({command.split()})"
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
    source = Path(__file__).parents[1] / "dq_marine" / "vehicles" / "bluerov2_heavy.toml"
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
    from dq_marine import vehicle_commands

    waited = []
    monkeypatch.setattr(vehicle_commands, "wait_for_interrupt", lambda: waited.append(True))
    monkeypatch.setattr("dq_marine.viewer.live.display_present", lambda: False)
    result = run("vehicles", "show", "bluerov2")
    assert result.exit_code == 0, result.output
    assert "Ctrl-C" in result.output
    assert waited == [True]


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


@pytest.mark.parametrize(
    ("arguments", "pattern"),
    [
        ("fly --agent zero --run runs/ppo", r"--agent zero and --run runs/ppo name two pilots; give one"),
        (
            "fly --current east --plot x.png",
            r"--current east is neither a speed nor three components; give 0\.3 or",
        ),
        ("fly --current 0.1,0.2 --plot x.png", r"--current 0\.1,0\.2 is neither"),
        ("fly --vehicle titanic --plot x.png", r"no vehicle 'titanic'; the catalogue holds .*bluerov2_heavy"),
        ("fly --seconds -3 --plot x.png", r"seconds = -3; give"),
        ("fly --run nowhere --plot x.png", r"nowhere holds no run"),
        ("evaluate --run nowhere", r"nowhere holds no run"),
        ("evaluate --current -0.5", r"current = -0\.5 m/s; give a speed of 0 or more"),
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


def test_interrupted_training_says_how_to_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dq_marine.agents import training

    def interrupted(*arguments: object, **keywords: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(training, "begin_training", interrupted)
    result = run("train", "--run", tmp_path / "run")
    assert result.exit_code == 130
    assert re.search(r"Go on: dq-marine train --run .*run --resume", result.output)


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
