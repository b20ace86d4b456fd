"""Flights with a panel: in a live page, episode after episode, until the person quits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.choice import make_agents
from dq_marine.agents.controllers.baselines import BASELINES, Agent, make_baseline
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.flight import (
    FlightPlan,
    Outputs,
    open_flight,
    options_of,
    periods_of,
    write_outputs,
)
from dq_marine.agents.interactive.conductor import HELM, Conductor
from dq_marine.agents.interactive.helm import Helm
from dq_marine.envs.core.view import open_page, shape_of
from dq_marine.errors import InvalidInputError


def fly_interactively(
    plan: FlightPlan,
    make_agents: Callable[[gym.Env[Any, Any]], Mapping[str, Agent]],
    outputs: Outputs,
    *,
    title: str,
    teleoperated: bool = False,
) -> Episode:
    """Fly in a live page with a panel, until the person quits there or presses Ctrl-C.

    Args:
        plan: what to fly; the person may choose other seeds.
        make_agents: given the environment, returns who can fly it besides the helm, by name.
        outputs: files that tell of the last episode.
        title: above the plot; "{seed}" in it becomes the seed.
        teleoperated: whether the helm flies at first, and not the first of the agents.

    Returns:
        The last episode.

    Raises:
        InvalidInputError: the plan is wrong, or a file cannot be written.
        MissingDependencyError: the viewer's or the plot's libraries are not installed.
    """
    env, seed = open_flight(plan, outputs)
    try:
        inner, helm = marine(env), Helm(env)
        others = dict(make_agents(env))
        agents = {HELM: helm, **others} if teleoperated else {**others, HELM: helm}
        with open_page(shape_of(inner.vehicle), inner.vehicle.name) as page:
            conductor = Conductor(page, agents, helm, seed=seed)
            episode = _fly_on(env, conductor, plan, track=outputs.trajectory is not None)
        write_outputs(env, episode, outputs, title=title.replace("{seed}", str(episode.seed)))
    finally:
        env.close()
    return episode


def offered_agents(
    env: gym.Env[Any, Any], *, baselines: Sequence[str], runs: Sequence[Path], seed: int
) -> dict[str, Agent]:
    """Return those who can fly an environment, by name: first those that are asked for, then the other baselines.

    Raises:
        InvalidInputError: one that is asked for cannot fly it.
        MissingDependencyError: a run is named, and the libraries to load it are not installed.
    """
    agents = make_agents(baselines, runs, env, seed=seed)
    for name in BASELINES:
        if name not in agents:
            with suppress(InvalidInputError):  # no controller reads what this task shows
                agents[name] = make_baseline(name, env, seed)
    return agents


def _fly_on(env: gym.Env[Any, Any], conductor: Conductor, plan: FlightPlan, *, track: bool) -> Episode:
    """Fly episode after episode; return the last one."""
    while True:
        seed = conductor.seed
        options = options_of(env, plan, seed)
        episode = fly_episode(env, conductor, seed=seed, options=options, interruptible=True, track=track)
        whole = len(episode.actions) == periods_of(plan, env)
        if conductor.restarting:
            continue
        if conductor.quitting or not (episode.ended_early or whole):  # the latter by Ctrl-C
            return episode
        if not conductor.goes_on_after(_end_of(episode)):
            return episode


def _end_of(episode: Episode) -> str:
    """Return how an episode ended, in words."""
    how = "The task is done" if episode.success else "The task is not done"
    when = f"after {episode.time[-1]:.1f} s"
    return f"{how} {when}. Press play, or New episode, for another one."
