"""The door of the command line: drawn commands, each with some options, in an empty folder."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from support.trainings import preset
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError
from hostile.values import Rng

TEXTS = (
    "", " ", "x", "0", "-1", "nan", "inf", "-inf", "1e308", "1e-308", "1" * 400, "1,2", "1,2,3,4", "0x10", "1_0",
    "true", "no such", "~nosuchuser/x", "a" * 5000, "../../etc/passwd", "[red]markup[/red]", "\x1b[31mred", "\x07",
    "ünïcode", "\udcff", "a\nb", "--help", "-h", "-x", "--", "--no-such-option", "[", "{}", "null", "=",
    "a=b", "a.b.c=1", "current=", "current=[[[", "vehicle=3", "reward.effort=1e308", "reward=[]", "control_period=1e-9",
    "substeps=2.5", "current=50", "goal_position=[0,0,-9]", "weather=[{}]", "sensors=x", "randomise=x",
    "render_mode=human1", "dq_marine/NoSuch-v0", "no_such_module:X-v0", "os:X-v0", "CartPole-v1",
    "dq_marine/StationKeeping-v99", ".", "/", "/proc/nowhere/x.png", "no/such/folder.png", "x.txt",
    "bluerov2_heavy", "file.toml", "/etc/passwd",
)  # fmt: skip
"""What any option may be given."""

FLIGHT = {
    "--agent": ("zero", "controller", "random", "lqr", "mpc"),
    "--seed": ("0", "3"),
    "--vehicle": ("bluerov2_heavy",),
    "--task": ("dq_marine/StationKeeping-v0",),
    "--current": ("0.1", "0.1,0,0"),
    "--set": (
        "control_period=0.2",
        "substeps=2",
        "reward.effort=0.1",
        "current=0.2",
        "goal_position=[0,0,9]",
    ),
    "--preset": ("ppo", "sac"),
    "--print-preset": (None,),
}
SPEED = {"--speed": ("0.5", "2"), "--json": (None,)}
PLOTLESS = {"--no-plot": (None,), "--json": (None,), "--throttle": ("0.5",), "--step": ("0.05",)}

COMMANDS: dict[tuple[str, ...], dict[str, tuple[str | None, ...]]] = {
    ("fly", "--seconds", "1", "--trajectory", "t.csv"): FLIGHT
    | {"--html": ("r.html",), "--plot": ("p.png", "p.svg"), "--trajectory": ("u.csv",), "--start-distance": ("1",)},
    ("fly", "--plot", "p.png", "--run", "nowhere"): FLIGHT,
    ("evaluate", "--episodes", "1", "--set", "max_episode_steps=5"): FLIGHT
    | {"--json": ("s.json",), "--trajectories": ("flights",), "--format": ("csv", "parquet"), "--run": ("nowhere",)},
    ("train", "--run", "run", "--preset", "tiny_ppo.toml", "--timesteps", "64"): {
        "--algorithm": ("ppo", "sac", "crossq"),
        "--set": FLIGHT["--set"],
        "--vehicle": FLIGHT["--vehicle"],
        "--resume": (None,),
        "--force": (None,),
        "--run": ("tiny_ppo.toml", "."),
        "--seed": ("1",),
    },
    ("train", "--print-preset"): FLIGHT | {"--algorithm": ("ppo", "crossq"), "--run": ("run",), "--resume": (None,)},
    ("tasks",): {"--markdown": (None,)},
    ("tasks", "StationKeeping"): {"--markdown": (None,)},
    ("vehicles",): {},
    ("vehicles", "sheet", "otter"): SPEED,
    ("vehicles", "check", "tiny_ppo.toml"): SPEED,
    ("vehicles", "show", "--html", "v.html", "remus100"): {"--html": ("w.html",)},
    ("vehicles", "export", "supply_vessel"): {"--force": (None,)},
    ("vehicles", "from-mesh", "tiny_ppo.toml"): {
        "--mass": ("3",), "--draft": ("0.2",), "--afloat": (None,), "--unit": ("mm",), "--axes": ("fsd",),
        "--origin": ("mesh",), "--center-of-mass": ("0,0,0.1",), "--inertia": ("1,1,1",), "--shape": ("ship",),
        "--limits": ("1,0,0,0,0,1",), "--radiation": (None,), "--frequencies": ("4",), "--panels": ("100",),
        "--water-density": ("1025",), "--speed": ("2",), "--name": ("mine",), "--force": (None,),
    },
    ("vehicles", "randomise", "remus100", "--samples", "3"): {
        "--file": ("default", "published"), "--seed": ("1",), "--json": (None,),
    },
    ("vehicles", "fit", "bluerov2_heavy", "--log", "tiny_ppo.toml"): {
        "--fit": ("linear", "gains", "added_mass_full"), "--bound": ("0.1",), "--segment": ("10",), "--step": ("0.05",),
        "--current": ("0,0,0",), "--out": ("f.toml",), "--plot": ("f.png",), "--no-plot": (None,), "--force": (None,),
    },
    ("validate", "bluerov2_heavy", "--references", "trials.toml"): {"--json": (None,), "--out": ("page",)},
    ("manoeuvre", "otter", "zig-zag"): PLOTLESS,
    ("manoeuvre", "remus100", "decay"): PLOTLESS,
    ("sea", "--hs", "1", "--tp", "7", "--seconds", "100"): {
        "--spectrum": ("jonswap", "pierson-moskowitz", "ittc"), "--t1": ("5",), "--wind-speed": ("10",),
        "--gamma": ("2",), "--water-depth": ("30",), "--components": ("20",), "--seed": ("1",), "--plot": ("s.png",),
        "--json": (None,),
    },
    ("report", "--only", "no such study"): {"--case": ("x",), "--seed": ("1",), "--out": ("r",)},
    ("add",): {"--template": (None,), "--markdown": (None,)},
    ("add", "task"): {"--template": (None,)},
    ("demo", "--out", "tiny_ppo.toml"): {},
}  # fmt: skip
"""Commands with valid arguments that end soon, and the options that they may be given besides.

All that fly fly the same vehicle, or each would be compiled anew.
"""

TRIALS = """
[[trial]]
name = "half ahead"
manoeuvre = "steady"
wrench = [20.0, 0.0, 0.0, 0.0, 0.0, 0.0]
duration = 5.0
[[trial.expected]]
quantity = "surge_m_s"
at_least = 0.1
source = "none: what it may be is wide enough"
"""
"""Of a vehicle that it holds for; the command says with its exit status where numbers differ."""

NUMBER_TEXTS = ("", "x", "nan", "inf", "-1", "0", "1e308", "1e-308", "1" * 400, "0.5", "1.5", "-0.0", "2")


class CommandError(InvalidInputError):
    """A command ended with a message and an exit code other than 0."""


def drawn_command(rng: Rng) -> Callable[[], Any]:
    """A command with up to three options, of which some are wrong, and now and then a wrong argument."""
    commands = list(COMMANDS)
    command = commands[rng.integers(len(commands))]
    arguments = [*command]
    options = COMMANDS[command]
    for _ in range(rng.integers(4)):
        if options and rng.integers(6):
            name = list(options)[rng.integers(len(options))]
            known = options[name]
            given = known[rng.integers(len(known))]
            arguments += [name] if given is None else [name, wrong(rng) if rng.integers(2) else given]
        else:
            arguments.append(wrong(rng))
    if rng.integers(4) == 0:
        place = int(rng.integers(1, len(arguments))) if len(arguments) > 1 else 0
        arguments[place] = wrong(rng)
    return lambda: run_in_empty_folder([one for one in arguments if one not in OPENING])


OPENING = ("--live", "--watch")
"""Options that open a page and stay."""


def wrong(rng: Rng) -> str:
    texts = (TEXTS, NUMBER_TEXTS)[rng.integers(2)]
    return texts[rng.integers(len(texts))]


def run_in_empty_folder(arguments: list[str]) -> Any:
    """Run a command; raise what it raised, or a `CommandError` with its message if it ended with one."""
    before, folder = Path.cwd(), Path(tempfile.mkdtemp())
    preset(folder, "ppo", 64)
    (folder / "trials.toml").write_text(TRIALS, encoding="utf-8")
    os.chdir(folder)
    try:
        result = CliRunner().invoke(app, arguments)
    finally:
        os.chdir(before)
        shutil.rmtree(folder)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    shown = result.stdout + result.stderr
    assert "\x1b" not in shown, "control characters reached the terminal"
    assert "\x07" not in shown, "control characters reached the terminal"
    assert "Traceback" not in shown, "a traceback was shown"
    if result.exit_code == 1:
        assert any(line.startswith("Error: ") for line in result.stderr.splitlines()), (
            f"no message: {result.stderr}"
        )
        raise CommandError(result.stderr)
    if result.exit_code:
        assert "Usage" in result.stderr, f"exit code {result.exit_code} without a message"
        raise CommandError(result.stderr)
    return result
