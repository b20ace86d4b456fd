"""An environment to fly in, and who can fly it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.choice import make_agents
from dq_marine.agents.controllers.baselines import AGENTS, Agent, make_baseline
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, open_flight, options_of
from dq_marine.agents.interactive.helm import Helm
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.errors import InvalidInputError, MissingDependencyError

HELM = "helm"
"""What the helm is called among the agents."""

MakeAgents = Callable[[gym.Env[Any, Any]], Mapping[str, Agent]]
"""Given an environment, returns who can fly it besides the helm, by name."""


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


def offered_agents(
    env: gym.Env[Any, Any], *, baselines: Sequence[str], runs: Sequence[Path], seed: int
) -> dict[str, Agent]:
    """Return those who can fly an environment, by name: first those that are asked for, then all others.

    Raises:
        InvalidInputError: one that is asked for cannot fly it.
        MissingDependencyError: the libraries that one that is asked for needs are not installed.
    """
    agents = make_agents(baselines, runs, env, seed=seed)
    for name in AGENTS:
        if name not in agents:
            # No controller reads what this task shows, or its libraries are not there.
            with suppress(InvalidInputError, MissingDependencyError):
                agents[name] = make_baseline(name, env, seed)
    return agents


def opened_flight(
    plan: FlightPlan, make_agents: MakeAgents, outputs: Outputs, *, teleoperated: bool
) -> tuple[Flight, int]:
    """Return a flight, and the seed of its first episode.

    Raises:
        InvalidInputError: the plan is wrong, or a file could not be written after the flight.
        MissingDependencyError: a library that is needed is not installed.
    """
    env, seed = open_flight(plan, outputs)
    try:
        helm, others = Helm(env), dict(make_agents(env))
    except BaseException:
        env.close()
        raise
    agents: dict[str, Agent] = {HELM: helm, **others} if teleoperated else {**others, HELM: helm}
    return Flight(plan, env, agents, helm), seed


def begun_flight(plan: FlightPlan, make_agents: MakeAgents, outputs: Outputs) -> Flight:
    """Return a flight whose first episode can begin, compiled, with those who can fly it.

    Raises:
        InvalidInputError: the plan is wrong.
    """

    def those_who_can(env: gym.Env[Any, Any]) -> Mapping[str, Agent]:
        env.reset(seed=plan.seed, options=options_of(env, plan, plan.seed or 0))
        try:
            offered = make_agents(env)
        except InvalidInputError:  # one that was asked for flies the first environment, but not this one
            offered = offered_agents(env, baselines=(), runs=(), seed=plan.seed or 0)
        compile_step(env)
        return {name: agent for name, agent in offered.items() if _can_fly(agent, env)}

    flight, _ = opened_flight(plan, those_who_can, outputs, teleoperated=False)
    return flight


def replanned(plan: FlightPlan, environment: EnvironmentSettings, seed: int) -> FlightPlan:
    """Return a plan in another environment; a start that was asked for means nothing to another task."""
    changed = replace(plan, environment=environment, seed=seed)
    if environment.id == plan.environment.id:
        return changed
    return replace(changed, start={}, start_distance=None)


def compile_step(env: gym.Env[Any, Any]) -> None:
    """Have what the steps of an environment need compiled, or loaded; its episode stays as it is.

    Args:
        env: in an episode.
    """
    marine(env).foreseen(np.zeros(env.action_space.shape or (), np.float32))


def _can_fly(agent: Agent, env: gym.Env[Any, Any]) -> bool:
    try:
        agent.reset(env)
    except InvalidInputError:  # a policy that was trained on other observations
        return False
    return True
