"""Section: every task that ships, single and in lanes."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
from gymnasium.vector import AutoresetMode

from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.registry import shipped_tasks
from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import Timed
from suite.batch import named
from suite.environments import SHOWN_SIZE as SIZE
from suite.environments import Stretch, random_actions, row_of, run_in_turn
from suite.plan import LEAST, Plan, Section
from suite.tables import find, found, millions, noise, table

SINGLE = "single"

METHOD = f"""\
Every task with its default vehicle and settings, under random actions. *In lanes*: `gym.make_vec(id, num_envs={SIZE:,},
autoreset_mode="SameStep")` in strict float64, million environment steps (control periods) per second as a mean over
whole episodes, as in the section on environments. *Single*: `gym.make(id)`, thousand steps per second over the best
stretch of at least {LEAST * 1e3:.0f} ms, resets included.
"""


class Single:
    """A single environment under way, reset whenever an episode ends.

    Attributes:
        steps: that a call of `step` takes.
    """

    def __init__(self, identifier: str) -> None:
        self._env = gym.make(identifier)
        self._env.reset(seed=0)
        self._actions = random_actions(self._env.action_space.shape or ())
        self.steps = len(self._actions)

    def step(self) -> None:
        """Take a few steps."""
        for action in self._actions:
            _, _, terminated, truncated, _ = self._env.step(action)
            if terminated or truncated:
                self._env.reset()

    def close(self) -> None:
        """Close the environment."""
        self._env.close()


def measure(plan: Plan) -> dict[str, Any]:
    """Return times of a step of every task."""
    tasks = plan.pick(shipped_tasks(), shipped_tasks()[:2])
    return {"rows": [row for task in tasks for row in (single_row(plan, task), *lane_rows(plan, task))]}


def single_row(plan: Plan, task: TaskDefinition) -> Row:
    """Return the time of a step of a single environment."""
    plan.tell(f"{task.id}, single")
    env = Single(task.id)
    timing = plan.compare({SINGLE: Timed(env.step, env.steps)})[SINGLE]
    env.close()
    return {"task": task.id, "vehicle": task.vehicle, "environments": 1, **timing.full_row()}


def lane_rows(plan: Plan, task: TaskDefinition) -> list[Row]:
    """Return the times of a step in lanes, by number of threads."""
    plan.tell(f"{task.id}, {SIZE:,} in lanes")
    stretches = [stretch_of(task, threads) for threads in plan.threads]
    run_in_turn(stretches, plan.progress)
    rows = [
        {"task": task.id, "vehicle": task.vehicle, **row_of(SIZE, ("strict", "float64", threads), stretch)}
        for threads, stretch in zip(plan.threads, stretches, strict=True)
    ]
    for stretch in stretches:
        stretch.envs.close()
    return rows


def stretch_of(task: TaskDefinition, threads: int) -> Stretch:
    """Return environments in lanes, and actions for them."""
    envs = gym.make_vec(task.id, num_envs=SIZE, autoreset_mode=AutoresetMode.SAME_STEP, threads=threads)
    return Stretch(envs, random_actions(envs.action_space.shape or ()))


def tables(content: dict[str, Any]) -> str:
    """Return rates by task."""
    rows = content["rows"]
    threads = distinct([row for row in rows if "threads" in row], "threads")
    header = [
        "task",
        "vehicle",
        "single, thousand/s",
        *(f"in lanes, {named(one)}, million/s" for one in threads),
    ]
    lines = []
    for task in distinct(rows, "task"):
        single = found(rows, task=task, environments=1)
        lanes = (find(rows, task=task, environments=SIZE, threads=one) for one in threads)
        thousands = three_digits(1e6 / single["best_ns"])
        lines.append([task, single["vehicle"], thousands, *(millions(row, "mean_ns") for row in lanes)])
    return "\n".join([table(header, lines), noise(rows)])


def headline(content: dict[str, Any]) -> str:
    """Return the lowest and the highest rates."""
    rows = content["rows"]
    most = max(row["threads"] for row in rows if "threads" in row)
    lanes = sorted((row for row in rows if row.get("threads") == most), key=lambda row: row["mean_ns"])
    singles = sorted(1e6 / row["best_ns"] for row in rows if row["environments"] == 1)
    return (
        f"{len(singles)} tasks: single {three_digits(singles[0])} to {three_digits(singles[-1])} thousand steps/s; "
        f"{SIZE:,} in lanes, {named(most)}: {millions(lanes[-1], 'mean_ns')} to {millions(lanes[0], 'mean_ns')} million"
    )


SECTION = Section("tasks", "Tasks", METHOD, measure, tables, headline)
