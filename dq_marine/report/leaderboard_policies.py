"""Trained policies on the leaderboard: what each was trained for, and what it can fly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from dq_marine.agents.controllers.baselines import AGENTS
from dq_marine.agents.environments import make_environment, marine, space_shape
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.training.run_folder import MODEL_FILE, RunFolder
from dq_marine.agents.training.snapshots import digests_of
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError


@dataclass(frozen=True)
class Policy:
    """The policy of a training run.

    Attributes:
        name: of the run's folder.
        folder: of the run.
        digest: a hash over its model: results of another are not its.
        environment: that it was trained in.
    """

    name: str
    folder: Path
    digest: str
    environment: EnvironmentSettings

    @property
    def task(self) -> str:
        """The id of the task that it was trained for."""
        return self.environment.id

    @cached_property
    def vehicle(self) -> str:
        """The vehicle that it was trained with, as the environment was given it."""
        default = marine(make_environment(EnvironmentSettings(id=self.task))).definition.vehicle
        return str(self.environment.keywords.get("vehicle", default))

    @cached_property
    def shapes(self) -> Any:
        """Of what it observes and what it commands."""
        return _shapes(self.environment)

    def fits(self, environment: EnvironmentSettings) -> bool:
        """Whether an environment is of its task, and shows and takes as many numbers as that of its training."""
        return environment.id == self.task and _shapes(environment) == self.shapes


def _shapes(environment: EnvironmentSettings) -> Any:
    env = make_environment(environment)
    return space_shape(env.observation_space), space_shape(env.action_space)


def policies_of(runs: Sequence[Path]) -> list[Policy]:
    """Return the policies of training runs.

    Raises:
        InvalidInputError: a folder holds no run or no model, or its name is another agent's.
    """
    found: list[Policy] = []
    for run in runs:
        folder, name = RunFolder(run), run.resolve().name
        if name in (*AGENTS, *(one.name for one in found)):
            raise InvalidInputError(f"there are two agents called {shown(name)}; rename the folder {run}")
        environment = folder.read_plan().settings.environment
        digest = digests_of(folder.trained_snapshot)[MODEL_FILE][:16]
        found.append(Policy(name, run.resolve(), digest, environment))
    return found
