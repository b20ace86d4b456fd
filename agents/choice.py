"""Agents by the names that people give: baselines, and the folders of training runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.controllers.baselines import Agent, make_baseline
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT
from dq_marine.agents.keywords import differences
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.training.run_folder import RunFolder
from dq_marine.errors import InvalidInputError


def common_environment(
    runs: Sequence[Path],
    *,
    base: EnvironmentSettings = DEFAULT_ENVIRONMENT,
    change: Callable[[EnvironmentSettings], EnvironmentSettings] = lambda settings: settings,
) -> EnvironmentSettings:
    """Return the environment that the runs were trained in, changed as asked; without runs, `base`.

    Raises:
        InvalidInputError: a folder holds no run, or even so changed the runs' environments differ.
    """
    environments = [change(RunFolder(run).read_plan().settings.environment) for run in runs]
    for run, environment in zip(runs, environments, strict=True):
        if environment != environments[0]:
            raise InvalidInputError(
                f"{run} was trained in {environment.id} with {environment.keywords}, {runs[0]} in "
                f"{environments[0].id} with {environments[0].keywords}; compare them one at a time, or say with --set "
                "what they are to be compared in"
            )
    return environments[0] if environments else change(base)


def other_conditions(
    runs: Sequence[Path], environment: EnvironmentSettings
) -> dict[str, dict[str, tuple[Any, Any]]]:
    """Return by run in what its training's environment differs from one, with both values; None is the default."""
    found = {
        _name(run): differences(RunFolder(run).read_plan().settings.environment, environment) for run in runs
    }
    return {name: differing for name, differing in found.items() if differing}


def make_agents(
    baselines: Sequence[str], runs: Sequence[Path], env: gym.Env[Any, Any], *, seed: int
) -> dict[str, Agent]:
    """Return agents by name; a run goes by its folder's.

    Args:
        baselines: names among `dq_marine.agents.controllers.baselines.AGENTS`.
        runs: folders of training runs.
        env: what they are to fly.
        seed: of agents that draw.

    Raises:
        InvalidInputError: a name is unknown or given twice, or a folder holds no trained run.
        MissingDependencyError: the libraries that a run or a controller needs are not installed.
    """
    agents = {name: make_baseline(name, env, seed) for name in baselines}
    for run in runs:
        from dq_marine.agents.training.trained_policy import TrainedPolicy  # here: it imports torch

        name = _name(run)
        if name in agents:
            raise InvalidInputError(f"there are two agents called {name!r}; rename the folder {run}")
        agents[name] = TrainedPolicy(RunFolder(run))
    return agents


def _name(run: Path) -> str:
    """Return what a run goes by."""
    return run.resolve().name
