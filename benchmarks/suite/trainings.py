"""Trainings by the command, kept in a folder with what they cost, and flights of what they learned."""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.agents.policies import load_policy, trained_environment
from dq_marine.agents.policy_names import shipped_policies
from dq_marine.util.files import with_folder, write_json
from suite import circumstances

UNSEEN = 5_000_000
"""Seed of the first episode: beyond those of trainings and evaluations."""


def trained(options: Sequence[str], folder: Path) -> dict[str, Any]:
    """Return the summary of a run with its times, which is trained by the command with options if it is not there."""
    file, command_file = folder / "summary.json", folder / "command.json"
    if not file.is_file():
        command = [sys.executable, "-m", "dq_marine", "train", *options, "--run", str(folder), "--force"]
        began, before = time.monotonic(), processor_time()
        subprocess.run(command, check=True)
        times = {"command_s": time.monotonic() - began, "processor_s": processor_time() - before}
        write_json(command_file, times)
    summary: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return summary | json.loads(command_file.read_text(encoding="utf-8"))


TIMES = ("wall time [s]", "processor time [s]")
"""What heads the cells that `times_of` returns."""


def times_of(run: dict[str, Any]) -> list[str]:
    """Return how long the command of a run took, and of a processor, as the cells of a row."""
    return [f"{run[name]:.0f}" for name in ("command_s", "processor_s")]


def options(description: str, episodes: int) -> argparse.ArgumentParser:
    """Return a parser of what all programs that train ask for, with so many episodes by default."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--preset", action="append", choices=list(shipped_policies()))
    parser.add_argument("--episodes", type=int, default=episodes)
    parser.add_argument("--runs", type=Path, default=circumstances.ROOT / "runs")
    return parser


def processor_time() -> float:
    """Return what children that have ended took of the processor [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def successes(folder: Path, policy: Path, episodes: int) -> int:
    """Return in how many unseen episodes a policy succeeds in what it was trained in; kept in a folder once flown."""
    file = folder / f"successes_{episodes}.json"
    if not file.is_file():
        env, agent = make_environment(trained_environment(policy)), load_policy(policy)
        flown = [fly_episode(env, agent, seed=UNSEEN + number).success for number in range(episodes)]
        env.close()
        write_json(with_folder(file), {"successes": sum(flown)})
    found: int = json.loads(file.read_text(encoding="utf-8"))["successes"]
    return found
