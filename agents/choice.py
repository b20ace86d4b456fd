"""Agents by the names that people give: baselines, and trained policies by their paths."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.controllers.baselines import Agent, make_baseline
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.keywords import differences
from dq_marine.agents.policies import load_policy, named_policies, trained_environment
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.errors import InvalidInputError


def common_environment(
    policies: Sequence[Path],
    *,
    base: EnvironmentSettings = DEFAULT_ENVIRONMENT,
    change: Callable[[EnvironmentSettings], EnvironmentSettings] = lambda settings: settings,
) -> EnvironmentSettings:
    """Return the environment that the policies were trained in, changed as asked; without policies, `base`.

    Raises:
        InvalidInputError: there is no policy at a path, or even so changed the policies' environments differ.
        MissingDependencyError: the library that reads an exported policy is not installed.
    """
    environments = [change(trained_environment(policy)) for policy in policies]
    for policy, environment in zip(policies, environments, strict=True):
        if environment != environments[0]:
            raise InvalidInputError(
                f"{policy} was trained in {environment.id} with {environment.keywords}, {policies[0]} in "
                f"{environments[0].id} with {environments[0].keywords}; compare them one at a time, or say with --set "
                "what they are to be compared in"
            )
    return environments[0] if environments else change(base)


def other_conditions(
    policies: Sequence[Path], environment: EnvironmentSettings
) -> dict[str, dict[str, tuple[Any, Any]]]:
    """Return by policy in what its training's environment differs from one, with both values; None is the default."""
    found = {
        name: differences(trained_environment(policy), environment)
        for name, policy in named_policies(policies)
    }
    return {name: differing for name, differing in found.items() if differing}


def make_agents(
    baselines: Sequence[str], policies: Sequence[Path], env: gym.Env[Any, Any], *, seed: int
) -> dict[str, Agent]:
    """Return agents by name, policies by those of `named_policies`.

    Args:
        baselines: names among `dq_marine.agents.controllers.baselines.AGENTS`.
        policies: folders of training runs, or files that were exported from them.
        env: what they are to fly.
        seed: of agents that draw.

    Raises:
        InvalidInputError: a name is unknown or given twice, there is no policy at a path, or one was trained for other
            observations or actions than those of the environment.
        MissingDependencyError: the libraries that a policy or a controller needs are not installed.
    """
    agents = {name: make_baseline(name, env, seed) for name in baselines}
    for name, policy in named_policies(policies):
        if name in agents:
            raise InvalidInputError(f"there are two agents called {name!r}; rename {policy}")
        agents[name] = load_policy(policy)
        # If this is not what it was trained for, it says so here, before anything is shown.
        agents[name].reset(env)
    return agents
