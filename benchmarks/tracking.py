"""Compare what tracks a point that moves: the baseline, LQR and MPC, in the same seeded episodes.

Run: python benchmarks/tracking.py [--episodes N] [--vehicle NAME ...] [--level NAME ...] [--out FILE]

Writes the tables of docs/tracking.md, between its words. Errors are root mean squares over all instants of all
episodes, with the way from the start to the point, and over the last thirds of the episodes, without it. The time of an
action is the median over all of them.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from suite import circumstances
from suite.tables import table

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.controllers.baselines import Agent, make_baseline
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.report.machine import load, machine, versions
from dq_marine.util.files import with_folder, write_whole

PAGE = circumstances.ROOT / "docs" / "tracking.md"
ID = "dq_marine/TrajectoryTracking-v0"
AGENTS = ("controller", "lqr", "mpc")
BEGIN, END = "<!-- benchmarks/tracking.py -->\n", "<!-- end -->\n"
HEADER = (
    "agent",
    "success",
    "position [m]",
    "in the last third",
    "heading [deg]",
    "in the last third",
    "effort",
    "change of the action",
    "time per action [ms]",
    "unsolved",
)


class Timed:
    """An agent whose actions are timed."""

    def __init__(self, agent: Agent) -> None:
        self.agent = agent
        self.seconds: list[float] = []

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Prepare the agent."""
        self.agent.reset(env)

    def act(self, observation: Any) -> Any:
        """Return the agent's action."""
        began = time.perf_counter()
        action = self.agent.act(observation)
        self.seconds.append(time.perf_counter() - began)
        return action


def root_mean_square(episodes: Sequence[Episode], name: str, *, steady: bool) -> float:
    """Return that of a metric over all instants of the episodes, or over their last thirds."""
    chosen = [one.measured[name][one.last_third if steady else slice(None)] for one in episodes]
    return float(np.sqrt(np.mean(np.square(np.concatenate(chosen)))))


def row(name: str, env: gym.Env[Any, Any], episodes: int) -> tuple[str, ...]:
    """Return the row of an agent that flies episodes seeded 0, 1, ..."""
    timed = Timed(make_baseline(name, env))
    flown = [fly_episode(env, timed, seed=seed) for seed in range(episodes)]
    errors = [
        factor * root_mean_square(flown, metric, steady=steady)
        for metric, factor in (("position_error", 1.0), ("heading_error", np.degrees(1.0)))
        for steady in (False, True)
    ]
    effort = float(np.mean([one.effort for one in flown]))
    change = float(np.mean([one.action_change for one in flown]))
    numbers = [*errors, effort, change, 1e3 * float(np.median(timed.seconds))]
    unsolved = getattr(timed.agent, "unsolved", None)
    return (
        name,
        f"{sum(one.success for one in flown)} of {episodes}",
        *(f"{number:.3g}" for number in numbers),
        "" if unsolved is None else f"{unsolved} of {len(timed.seconds)}",
    )


def section(vehicle: str, level: str, episodes: int) -> str:
    """Return the table of a vehicle and a level, with its heading."""
    env = gym.make(ID, vehicle=vehicle, level=level, disable_env_checker=True)
    rows = [row(name, env, episodes) for name in AGENTS]
    return f"### {vehicle}, {level}\n\n{table(HEADER, rows)}\n"


def provenance(wanted: argparse.Namespace, load_before: float | None) -> str:
    """Return command, machine, its load before, and versions, as a paragraph."""
    command = ["python benchmarks/tracking.py", f"--episodes {wanted.episodes}"]
    command += [f"--vehicle {one}" for one in wanted.vehicle] + [f"--level {one}" for one in wanted.level]
    own = machine()
    installed = versions(("numpy", "numba", "scipy", "osqp", "gymnasium"))
    libraries = ", ".join(f"{name} {version}" for name, version in installed.items())
    return (
        f"`{' '.join(command)}`\n\n{own['cpu']}, {own['cores']} cores, load {load_before}; {libraries}; "
        f"commit {circumstances.commit()}.\n"
    )


def main() -> None:
    """Fly, and write the tables into the page."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--episodes", type=int, default=50)
    parser.add_argument("--vehicle", action="append")
    parser.add_argument("--level", action="append")
    parser.add_argument("--out", type=Path, default=PAGE)
    wanted = parser.parse_args()
    wanted.vehicle = wanted.vehicle or ["bluerov2_heavy", "rexrov"]
    wanted.level = wanted.level or ["medium", "hard"]
    load_before = load()
    sections = [section(one, level, wanted.episodes) for level in wanted.level for one in wanted.vehicle]
    words = PAGE.read_text(encoding="utf-8")
    before, rest = words.split(BEGIN)
    tables = f"{BEGIN}\n{provenance(wanted, load_before)}\n{''.join(sections)}"
    write_whole(with_folder(wanted.out), before + tables + END + rest.split(END)[1])


if __name__ == "__main__":
    main()
