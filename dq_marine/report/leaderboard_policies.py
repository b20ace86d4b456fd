"""Trained policies on the leaderboard: what each was trained for, and what it can fly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from dq_marine.agents.controllers.baselines import AGENTS
from dq_marine.agents.environments import make_environment, marine, with_keywords
from dq_marine.agents.policies import named_policies, policy_digest, trained_environment
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError


@dataclass(frozen=True)
class Policy:
    """A trained policy.

    Attributes:
        name: of the run's folder, or of the exported file.
        path: of that folder or file.
        digest: a hash over its model: results of another are not its.
        environment: that it was trained in.
    """

    name: str
    path: Path
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
    def interface(self) -> Any:
        """What it observes and what it commands."""
        return _interface(self.environment)

    def flown_in(self, environment: EnvironmentSettings) -> EnvironmentSettings:
        """Return an environment with the actuation of the policy's training, unless it has one of its own."""
        own = None if "actuation" in environment.keywords else self.environment.keywords.get("actuation")
        return with_keywords(environment, actuation=own)

    def fits(self, environment: EnvironmentSettings) -> bool:
        """Whether an environment is of its task, and shows and takes the same numbers as that of its training."""
        return environment.id == self.task and _interface(self.flown_in(environment)) == self.interface


def _interface(environment: EnvironmentSettings) -> Any:
    """Return names and sizes of what is observed, and names of what is commanded."""
    inner = marine(make_environment(environment))
    return [(one.name, one.size) for one in inner.observations], inner.action_names


def policies_of(paths: Sequence[Path]) -> list[Policy]:
    """Return the policies of training runs and of exported files.

    Raises:
        InvalidInputError: there is no policy at a path, or its name is another agent's.
        MissingDependencyError: the library that reads an exported policy is not installed.
    """
    found: list[Policy] = []
    for name, path in named_policies(paths):
        if name in (*AGENTS, *(one.name for one in found)):
            raise InvalidInputError(f"there are two agents called {shown(name)}; rename {path}")
        environment = trained_environment(path)
        found.append(Policy(name, path.absolute(), policy_digest(path), environment))
    return found
