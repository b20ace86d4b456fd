"""Agents by the names that people give: baselines, and the folders of training runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.policies import Agent, make_baseline
from dq_marine.agents.run_folder import RunFolder
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.errors import InvalidInputError


def common_environment(runs: Sequence[Path]) -> EnvironmentSettings:
    """Return the environment that the runs were trained in; without runs, station keeping.

    Raises:
        InvalidInputError: a folder holds no run, or the runs were trained in different environments.
    """
    environments = [RunFolder(run).read_plan().settings.environment for run in runs]
    for run, environment in zip(runs, environments, strict=True):
        if environment != environments[0]:
            raise InvalidInputError(
                f"{run} was trained in {environment.id} with {environment.keywords}, {runs[0]} in "
                f"{environments[0].id} with {environments[0].keywords}; compare them one at a time"
            )
    return environments[0] if environments else DEFAULT_ENVIRONMENT


def make_agents(
    baselines: Sequence[str], runs: Sequence[Path], env: gym.Env[Any, Any], *, seed: int
) -> dict[str, Agent]:
    """Return agents by name; a run goes by its folder's.

    Args:
        baselines: names among `dq_marine.agents.policies.BASELINES`.
        runs: folders of training runs.
        env: what they are to fly.
        seed: of agents that draw.

    Raises:
        InvalidInputError: a name is unknown or given twice, or a folder holds no trained run.
        MissingDependencyError: a run is named, and the libraries to load it are not installed.
    """
    agents = {name: make_baseline(name, env, seed) for name in baselines}
    for run in runs:
        from dq_marine.agents.trained_policy import TrainedPolicy  # here: it imports torch

        name = run.resolve().name
        if name in agents:
            raise InvalidInputError(f"there are two agents called {name!r}; rename the folder {run}")
        agents[name] = TrainedPolicy(RunFolder(run))
    return agents
