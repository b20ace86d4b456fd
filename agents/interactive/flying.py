"""Flights with a panel: in a live page, episode after episode, until the person quits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
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
from dq_marine.agents.interactive.next_episode import NextEpisode
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.view import open_page, shape_of
from dq_marine.errors import DQMarineError, InvalidInputError

MakeAgents = Callable[[gym.Env[Any, Any]], Mapping[str, Agent]]

MAKING = "Making the next environment; the first time, compiling it takes 10 to 20 s."


@dataclass(frozen=True)
class Flight:
    """What is flown, and who can fly it.

    Attributes:
        plan: of its episodes; the person may choose other seeds.
        env: the environment that follows from it.
        agents: by name, the helm among them.
        helm: what a person's hands do.
    """

    plan: FlightPlan
    env: gym.Env[Any, Any]
    agents: Mapping[str, Agent]
    helm: Helm


def fly_interactively(
    plan: FlightPlan,
    make_agents: MakeAgents,
    outputs: Outputs,
    *,
    title: str,
    teleoperated: bool = False,
) -> Episode:
    """Fly in a live page with a panel, until the person quits there or presses Ctrl-C.

    Args:
        plan: what to fly at first; the person may choose other seeds, and another environment.
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
    flight, seed = _opened(plan, make_agents, outputs, teleoperated=teleoperated)
    try:
        inner, next_episode = marine(flight.env), NextEpisode(plan.environment)
        with open_page(shape_of(inner.vehicle), inner.vehicle.name) as page:
            conductor = Conductor(page, flight.agents, flight.helm, seed=seed, next_episode=next_episode)
            while True:
                episode = _fly_one(flight, conductor, track=outputs.trajectory is not None)
                if not _wants_another(flight, conductor, episode):
                    break
                if next_episode.changed:
                    flight = _changed(flight, conductor, next_episode, make_agents, outputs)
                if conductor.quitting:
                    break
        write_outputs(flight.env, episode, outputs, title=title.replace("{seed}", str(episode.seed)))
    finally:
        flight.env.close()
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


def _opened(
    plan: FlightPlan, make_agents: MakeAgents, outputs: Outputs, *, teleoperated: bool
) -> tuple[Flight, int]:
    """Return a flight, and the seed of its first episode."""
    env, seed = open_flight(plan, outputs)
    try:
        helm, others = Helm(env), dict(make_agents(env))
    except BaseException:
        env.close()
        raise
    agents: dict[str, Agent] = {HELM: helm, **others} if teleoperated else {**others, HELM: helm}
    return Flight(plan, env, agents, helm), seed


def _fly_one(flight: Flight, conductor: Conductor, *, track: bool) -> Episode:
    seed = conductor.seed
    options = options_of(flight.env, flight.plan, seed)
    return fly_episode(flight.env, conductor, seed=seed, options=options, interruptible=True, track=track)


def _wants_another(flight: Flight, conductor: Conductor, episode: Episode) -> bool:
    """Return whether the person wants another episode, which is asked where this one came to its end."""
    if conductor.restarting:
        return True
    whole = len(episode.actions) == periods_of(flight.plan, flight.env)
    if conductor.quitting or not (episode.ended_early or whole):  # the latter by Ctrl-C
        return False
    return conductor.goes_on_after(_end_of(episode))


def _changed(
    flight: Flight,
    conductor: Conductor,
    next_episode: NextEpisode,
    make_agents: MakeAgents,
    outputs: Outputs,
) -> Flight:
    """Return the flight that the person has chosen; the one before, if there cannot be such a one or they quit."""
    try:
        plan = _replanned(flight.plan, next_episode.settings, conductor.seed)
        with ThreadPoolExecutor(1) as aside:
            work = aside.submit(_begun, plan, make_agents, outputs)
            conductor.wait_for(work, MAKING)
        changed = work.result()
    except DQMarineError as error:
        conductor.say_next(str(error))
        return flight
    if conductor.quitting:  # the files tell of the episode before
        changed.env.close()
        return flight
    flight.env.close()
    next_episode.changed = False
    conductor.take_over(changed.env, changed.agents, changed.helm)
    return changed


def _replanned(plan: FlightPlan, environment: EnvironmentSettings, seed: int) -> FlightPlan:
    """Return a plan in another environment; a start that was asked for means nothing to another task."""
    changed = replace(plan, environment=environment, seed=seed)
    if environment.id == plan.environment.id:
        return changed
    return replace(changed, start={}, start_distance=None)


def _begun(plan: FlightPlan, make_agents: MakeAgents, outputs: Outputs) -> Flight:
    """Return a flight whose first episode can begin, with those who can fly it."""

    def those_who_can(env: gym.Env[Any, Any]) -> Mapping[str, Agent]:
        env.reset(seed=plan.seed, options=options_of(env, plan, plan.seed or 0))
        try:
            offered = make_agents(env)
        except InvalidInputError:  # one that was asked for flies the first environment, but not this one
            offered = offered_agents(env, baselines=(), runs=(), seed=plan.seed or 0)
        return {name: agent for name, agent in offered.items() if _can_fly(agent, env)}

    flight, _ = _opened(plan, those_who_can, outputs, teleoperated=False)
    return flight


def _can_fly(agent: Agent, env: gym.Env[Any, Any]) -> bool:
    try:
        agent.reset(env)
    except InvalidInputError:  # a policy that was trained on other observations
        return False
    return True


def _end_of(episode: Episode) -> str:
    """Return how an episode ended, in words."""
    how = "The task is done" if episode.success else "The task is not done"
    when = f"after {episode.time[-1]:.1f} s"
    return f"{how} {when}. Press play, or New episode, for another one."
