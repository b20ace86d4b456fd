"""Study: how often Newton's method is asked again, and how often it needs fallback."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.report.cells import cells, summary
from dq_marine.report.extreme import STEPS, started
from dq_marine.report.methods import METHODS
from dq_marine.report.plan import Plan, Row, Rows, Study, Unit
from dq_marine.report.showing.solver_view import checks, drawings, findings, tables
from dq_marine.report.trial import DONE, Trial
from dq_marine.simulation.scene import Scene

ENVIRONMENT = "dq_marine/StationKeeping-v0"
PERIODS = 300
COUNTED = ("dqvi2", "dqvi_paper")
"""Methods with one drift a step."""

METHOD = f"""\
Newton iterations of each step, and steps that plain Newton did not solve on the branch from rest: those are
*fallbacks*, by following the solution from rest or by splitting the step, or *refused*. Ordinary: episodes of
`{ENVIRONMENT}` under random actions, {PERIODS} control periods each, every substep looked at from the environment's
own states. Extreme: the motions of the study of extremes, for the default drift and for that of the paper."""


def units(plan: Plan) -> list[Unit]:
    """Return the ordinary and the extreme."""
    episodes = plan.pick(20, 4)
    found = [
        Unit(
            "ordinary",
            partial(ordinary_rows, episodes, plan.seed),
            {"episodes": episodes, "seed": plan.seed},
            weight=0.1 * episodes,
        )
    ]
    return [
        *found,
        *(
            Unit(f"extreme-{name}", partial(extreme_rows, plan, name), summary(plan), weight=4.0)
            for name in COUNTED
        ),
    ]


def ordinary_rows(episodes: int, seed: int) -> Rows:
    """Return counts of steps by iterations, over episodes of the environment."""
    env = gym.make(ENVIRONMENT)
    counts: Counter[tuple[int, str]] = Counter()
    rng = np.random.default_rng(seed)
    try:
        for episode in range(episodes):
            env.reset(seed=seed + episode)
            follow_episode(env, rng, counts)
    finally:
        env.close()
    return rows_of(counts, "ordinary", "dqvi2")


def follow_episode(env: Any, rng: np.random.Generator, counts: Counter[tuple[int, str]]) -> None:
    """Count the steps of an episode: of a body that is put where the environment's is, period by period."""
    inner = env.unwrapped
    current = inner.episode.current_ned
    scene = Scene(inner.vehicle, current=current, scheme=inner.scene.scheme, step=inner.scene.step)
    body = Trial(scene.composition, scene.parameters_at, scene.step)
    limits = inner.vehicle.wrench_limits
    for _ in range(PERIODS):
        state = inner.get_state()["state"]
        body.set_state(np.concatenate([[0.0], state]))
        action = rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32)
        wrench = np.zeros(6)
        wrench[inner.action_mapping.places] = action
        count_steps(body, limits * wrench, inner.substeps, counts)
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            break


def extreme_rows(plan: Plan, name: str) -> Rows:
    """Return counts of steps by iterations, over the extreme motions."""
    counts: Counter[tuple[int, str]] = Counter()
    for cell in cells(plan):
        body = started(cell, METHODS[name], cell.step)
        count_steps(body, np.zeros(6), STEPS, counts)
    return rows_of(counts, "extreme", name)


def count_steps(body: Trial, wrench: Any, steps: int, counts: Counter[tuple[int, str]]) -> None:
    """Step a body, and count how each step was solved."""
    for _ in range(steps):
        iterations, fallbacks = body.newton_iterations, body.fallback_steps
        outcome = body.attempt(wrench)
        if outcome != DONE:
            counts[0, outcome] += 1
            return
        how = "fallbacks" if body.fallback_steps > fallbacks else "direct"
        counts[body.newton_iterations - iterations, how] += 1


def rows_of(counts: Counter[tuple[int, str]], scene: str, method: str) -> Rows:
    """Return the counts as rows, in order."""
    rows: list[Row] = []
    for iterations, how in sorted(counts):
        rows.append(
            {
                "scene": scene,
                "method": method,
                "how": how,
                "iterations": iterations,
                "steps": counts[iterations, how],
            }
        )
    return rows


STUDY = Study("solver", "How hard the solver works", METHOD, units, drawings, tables, findings, checks)
