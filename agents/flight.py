"""Flying one episode for people to see: live in the browser, as a replay, as a plot."""

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

from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.episodes import Episode, fly_episode
from dq_marine.agents.policies import Agent
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError


@dataclass(frozen=True)
class FlightPlan:
    """What to fly.

    Attributes:
        environment: the task.
        seconds: simulated time [s].
        seed: of the episode.
        start_distance: from the goal [m], at the goal's depth; None draws the whole start.
        start: further options of the environment's reset.
    """

    environment: EnvironmentSettings
    seconds: float = 30.0
    seed: int = 0
    start_distance: float | None = None
    start: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Outputs:
    """Where the flight is shown.

    Attributes:
        live: in a page in the browser, at real time; its address is told on standard error.
        html: a replay is written to this file.
        plot: errors and actions are drawn into this file.
    """

    live: bool = False
    html: Path | None = None
    plot: Path | None = None


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
        make_agent: given the environment, returns the pilot.
        outputs: where to show it; Ctrl-C ends a live flight early and still writes the files.
        title: above the plot.

    Raises:
        InvalidInputError: the plan is wrong, or a file cannot be written.
        MissingDependencyError: the viewer's or the plot's libraries are not installed.
    """
    _check_files(outputs)
    env = _make(plan, outputs)
    try:
        agent = make_agent(env)
        options = {**_start_options(env, plan), **plan.start}
        episode = fly_episode(env, agent, seed=plan.seed, options=options, interruptible=outputs.live)
        if outputs.html is not None:
            marine(env).save_html(outputs.html)
        if outputs.plot is not None:
            from dq_marine.agents.error_plot import save_plot

            save_plot(episode, outputs.plot, axis_names=marine(env).action_names, title=title)
    finally:
        env.close()
    return episode


def episode_table(episode: Episode) -> Table:
    """Return what came out of a flight as a table."""
    position, attitude_deg = episode.position_error, np.degrees(episode.attitude_error)
    settled = "not" if episode.settling_time is None else f"after {episode.settling_time:.1f} s"
    table = Table(show_header=False)
    table.add_column("quantity")
    table.add_column("value", justify="right", style="bold")
    table.add_row("position error, start", f"{position[0]:.3f} m")
    table.add_row("position error, end", f"{position[-1]:.3f} m")
    table.add_row("position error, mean of the last third", f"{position[episode.last_third].mean():.3f} m")
    table.add_row("attitude error, start", f"{attitude_deg[0]:.2f} deg")
    table.add_row("attitude error, end", f"{attitude_deg[-1]:.2f} deg")
    table.add_row("settled within 0.05 m and 2 deg", settled)
    table.add_row("return", f"{episode.total_reward:.1f}")
    if episode.ended_early:
        table.add_row("ended early", f"after {episode.time[-1]:.1f} s")
    return table


def _check_files(outputs: Outputs) -> None:
    """Refuse before the flight what could not be written after it."""
    for path in (outputs.html, outputs.plot):
        if path is not None and not path.parent.is_dir():
            raise InvalidInputError(f"the folder {path.parent} does not exist; create it first")
    if outputs.plot is not None:
        from dq_marine.agents.error_plot import check_picture_path  # here: it imports matplotlib

        check_picture_path(outputs.plot)


def _make(plan: FlightPlan, outputs: Outputs) -> gym.Env[Any, Any]:
    """Return the environment with the plan's time limit in place of its own."""
    mode = "human" if outputs.live else None
    inner = marine(make_environment(plan.environment, render_mode=mode, record=outputs.html is not None))
    if not (math.isfinite(plan.seconds) and plan.seconds >= inner.control_period):
        raise InvalidInputError(
            f"seconds = {plan.seconds:g}; give a time of at least one control period, {inner.control_period:g} s"
        )
    return TimeLimit(inner, max_episode_steps=round(plan.seconds / inner.control_period))


def _start_options(env: gym.Env[Any, Any], plan: FlightPlan) -> dict[str, Any]:
    """Return reset's options for a start at the plan's distance, in a direction that follows from its seed."""
    distance = plan.start_distance
    if distance is None:
        return {}
    inner = marine(env)
    farthest = getattr(inner, "workspace_radius", math.inf)
    if not 0.0 <= distance < farthest:
        raise InvalidInputError(
            f"start distance = {distance:g} m; give 0 or more and less than the workspace radius, {farthest:g} m"
        )
    goal = _goal_position(inner, plan.seed)
    direction = np.random.default_rng(plan.seed).uniform(-math.pi, math.pi)
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
