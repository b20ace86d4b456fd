"""Flying one episode for people to see: live in the browser, as a replay, as a video, as a plot."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.wrappers import TimeLimit
from rich.table import Table

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.metrics import REWARD_PREFIX
from dq_marine.agents.evaluation.trajectory import check_trajectory_path, write_columns
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_folder

LONGEST_FLIGHT = 1e6
"""Simulated time [s]; all of it is kept in memory."""

MOST_SEEDS = 1000
"""Tried for a start that is far from the goal."""


@dataclass(frozen=True)
class FlightPlan:
    """What to fly.

    Attributes:
        environment: the task.
        seconds: simulated time [s]; None for as long as the environment's episodes last.
        seed: of the episode; None for the first from 0 whose start is far from the goal.
        start_distance: from the goal [m], at the goal's depth; None draws the whole start.
        start: further options of the environment's reset.
    """

    environment: EnvironmentSettings
    seconds: float | None = 30.0
    seed: int | None = None
    start_distance: float | None = None
    start: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Outputs:
    """Where the flight is shown.

    Attributes:
        live: in a page in the browser, at real time; its address is told on standard error.
        html: a replay is written to this file.
        plot: metrics and actions are drawn into this file.
        trajectory: what was flown is written to this file, see `Episode.columns`.
        mp4: a video is written to this file, after the flight.
        fps: of the video [1/s]; None for a picture in each control period.
        progress: is told what part of the video is done, from 0 to 1.
    """

    live: bool = False
    html: Path | None = None
    plot: Path | None = None
    trajectory: Path | None = None
    mp4: Path | None = None
    fps: float | None = None
    progress: Callable[[float], None] = lambda done: None

    @property
    def files(self) -> tuple[Path, ...]:
        """Those that are written."""
        return tuple(path for path in (self.html, self.plot, self.trajectory, self.mp4) if path is not None)


def fly(
    plan: FlightPlan,
    make_agent: Callable[[gym.Env[Any, Any]], Agent],
    outputs: Outputs,
    *,
    title: str,
) -> Episode:
    """Fly one episode and show it.

    Args:
        plan: what to fly.
        make_agent: given the environment, returns the agent that flies it.
        outputs: where to show it; Ctrl-C ends a live flight early and still writes the files.
        title: above the plot; "{seed}" in it becomes the seed.

    Raises:
        InvalidInputError: the plan is wrong, or a file cannot be written.
        MissingDependencyError: the viewer's, the plot's or the video's libraries are not installed.
    """
    env, seed = open_flight(plan, outputs)
    try:
        agent = make_agent(env)
        episode = fly_episode(
            env,
            agent,
            seed=seed,
            options=options_of(env, plan, seed),
            interruptible=outputs.live,
            track=outputs.trajectory is not None,
        )
        write_outputs(env, episode, outputs, title=title.replace("{seed}", str(seed)))
    finally:
        env.close()
    return episode


def open_flight(plan: FlightPlan, outputs: Outputs) -> tuple[gym.Env[Any, Any], int]:
    """Return the environment to fly in, which the caller closes, and the seed of its first episode.

    Raises:
        InvalidInputError: the plan is wrong, or a file could not be written after the flight.
        MissingDependencyError: the plot's or the video's libraries are not installed.
    """
    _check_files(outputs)
    env = _make(plan, outputs)
    return env, far_seed(plan) if plan.seed is None else plan.seed


def options_of(env: gym.Env[Any, Any], plan: FlightPlan, seed: int) -> dict[str, Any]:
    """Return what the environment's reset is to be given for an episode of a plan.

    Raises:
        InvalidInputError: the plan's start is wrong.
    """
    return {**_start_options(env, plan, seed), **plan.start}


def write_outputs(env: gym.Env[Any, Any], episode: Episode, outputs: Outputs, *, title: str) -> None:
    """Write the files that tell of an episode, which was the environment's last one.

    Raises:
        InvalidInputError: a file cannot be written.
    """
    if outputs.html is not None:
        marine(env).save_html(outputs.html)
    if outputs.plot is not None:
        from dq_marine.agents.evaluation.error_plot import save_plot

        save_plot(episode, outputs.plot, title=title)
    if outputs.trajectory is not None:
        write_columns(episode.columns(), outputs.trajectory)
    if outputs.mp4 is not None:
        marine(env).save_mp4(outputs.mp4, fps=outputs.fps, progress=outputs.progress)


def episode_table(episode: Episode) -> Table:
    """Return what came out of a flight as a table."""
    table = Table(show_header=False)
    table.add_column("quantity")
    table.add_column("value", justify="right", style="bold")
    for quantity, value in episode_rows(episode).items():
        table.add_row(quantity, value)
    return table


def episode_rows(episode: Episode) -> dict[str, str]:
    """Return what came out of a flight as people read it, by quantity."""
    rows = {}
    for metric in episode.metrics:
        values = metric.shown(episode.measured[metric.name])
        rows[f"{metric.label}, start"] = metric.text(values[0])
        rows[f"{metric.label}, end"] = metric.text(values[-1])
        rows[f"{metric.label}, mean of the last third"] = metric.text(values[episode.last_third].mean())
    if episode.tolerances:
        limits = " and ".join(
            f"{metric.shown(tolerance):.4g} {metric.shown_unit}".rstrip()
            for metric, tolerance in episode.tolerances.items()
        )
        settled = "not" if episode.settling_time is None else f"after {episode.settling_time:.1f} s"
        rows[f"settled within {limits}"] = settled
    rows["return"] = f"{episode.total_reward:z.1f}"
    for name, values in episode.reward_terms.items():
        rows[f"  of which {name.removeprefix(REWARD_PREFIX)}"] = f"{math.fsum(values.tolist()):z.1f}"
    if episode.ended_early:
        rows["ended early"] = f"after {episode.time[-1]:.1f} s"
    rows["seed"] = str(episode.seed)
    return rows


def far_seed(plan: FlightPlan) -> int:
    """Return the first seed from 0 whose start is at least half the start radius away from the goal.

    It is 0 for tasks without a goal or a start radius, and where the plan says where to start.
    """
    if plan.start_distance is not None or "position" in plan.start:
        return 0
    env = make_environment(plan.environment)  # not the one that is flown: nobody is to see these starts
    inner = marine(env)
    radius = float(getattr(inner, "start_radius", 0.0))
    for seed in range(MOST_SEEDS if radius > 0.0 else 0):
        env.reset(seed=seed, options=plan.start or None)
        goal = inner.snapshot().goal_position_ned
        if goal is None or math.dist(inner.position_ned, goal) >= 0.5 * radius:
            return seed
    return 0


def _check_files(outputs: Outputs) -> None:
    """Refuse before the flight what could not be written after it."""
    for path in outputs.files:
        check_folder(path)
    if outputs.plot is not None:
        from dq_marine.util.figures import check_picture_path

        check_picture_path(outputs.plot, extra="agents")
    if outputs.trajectory is not None:
        check_trajectory_path(outputs.trajectory)
    if outputs.mp4 is not None:
        from dq_marine.viewer.video import check_video

        check_video(outputs.mp4, outputs.fps)


def _make(plan: FlightPlan, outputs: Outputs) -> gym.Env[Any, Any]:
    """Return the environment with the plan's time limit, if it has one, in place of its own."""
    mode = "human" if outputs.live else None
    record = outputs.html is not None or outputs.mp4 is not None
    made = make_environment(plan.environment, render_mode=mode, record=record)
    if plan.seconds is None:
        return made
    inner = marine(made)
    if not inner.control_period <= plan.seconds <= LONGEST_FLIGHT:
        raise InvalidInputError(
            f"seconds = {plan.seconds:g}; give a time of at least one control period, {inner.control_period:g} s, and "
            f"at most {LONGEST_FLIGHT:g} s"
        )
    return TimeLimit(inner, max_episode_steps=round(plan.seconds / inner.control_period))


def periods_of(plan: FlightPlan, env: gym.Env[Any, Any]) -> int | None:
    """Return how many control periods a plan's flight has at most; None if an environment of its own has no limit."""
    if plan.seconds is not None:
        return round(plan.seconds / marine(env).control_period)
    return None if env.spec is None else env.spec.max_episode_steps


def _start_options(env: gym.Env[Any, Any], plan: FlightPlan, seed: int) -> dict[str, Any]:
    """Return reset's options for a start at the plan's distance, in a direction that follows from the seed."""
    distance = plan.start_distance
    if distance is None:
        return {}
    inner = marine(env)
    farthest = getattr(inner, "workspace_radius", math.inf)
    if not 0.0 <= distance < farthest:
        raise InvalidInputError(
            f"start distance = {distance:g} m; give 0 or more and less than the workspace radius, {farthest:g} m"
        )
    goal = _goal_position(inner, seed)
    direction = np.random.default_rng(seed).uniform(-math.pi, math.pi)
    return {"position": goal + distance * np.array([math.cos(direction), math.sin(direction), 0.0])}


def _goal_position(env: MarineEnv, seed: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return where the episode of this seed has its goal, NED [m]."""
    env.reset(seed=seed)
    goal = env.snapshot().goal_position_ned
    if goal is None:
        raise InvalidInputError(
            "this task has no goal to start at a distance from; leave the start distance out"
        )
    return goal
