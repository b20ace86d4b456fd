"""A folder of Minari datasets, each with the episodes that were flown in one environment."""

from __future__ import annotations

import os
import re
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import gymnasium as gym
import numpy as np

from dq_marine.agents.environments import marine
from dq_marine.envs.core.observation import Observation
from dq_marine.util.extras import optional_library
from dq_marine.util.files import unwritable

PURPOSE, EXTRA = "recording flights", "interop"

FOLDER_VARIABLE = "MINARI_DATASETS_PATH"
"""Where Minari looks for the folder of its datasets."""


class DatasetFolder:
    """Keeps what is flown; a dataset is in the folder once it is whole.

    Attributes:
        written: how many episodes each dataset has, by its id.
    """

    def __init__(self, folder: Path) -> None:
        """Make the folder, if need be.

        Raises:
            MissingDependencyError: Minari, or what it writes with, is not installed.
            InvalidInputError: the folder cannot be made or written.
        """
        self._minari, *_ = (optional_library(PURPOSE, name, EXTRA) for name in ("minari", "h5py", "jax"))
        self.written: dict[str, int] = {}
        self._folder = folder.absolute()  # Minari would look for a relative one inside of itself
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._begun = tempfile.TemporaryDirectory(dir=self._folder, prefix=".recording-")
        except OSError as error:
            raise unwritable(folder, error) from error

    def recording(self, env: gym.Env[Any, Any], notes: Callable[[bool], dict[str, Any]]) -> gym.Env[Any, Any]:
        """Return an environment around one of this package that keeps what is flown in it.

        Args:
            env: whose episodes are kept.
            notes: what joins the `info` of the last step or, where its argument is false, of a reset.
        """
        with self._datasets_in(self._begun.name):
            collector: gym.Env[Any, Any] = self._minari.DataCollector(
                env, step_data_callback=lambda: StepData(notes), record_infos=True
            )
        return collector

    def keep(
        self, recorded: gym.Env[Any, Any], *, agent: str | None, algorithm: str, description: str
    ) -> None:
        """Write the episodes of an environment that `recording` returned, if any, as one dataset.

        Args:
            recorded: what `recording` returned.
            agent: the last part of the dataset's name; None leaves it out.
            algorithm: for the dataset's own account of itself, as is the next.
            description: for people.

        Raises:
            InvalidInputError: it cannot be written.
        """
        identifier = self._free_identifier(recorded, agent)
        try:
            with self._datasets_in(self._begun.name):
                dataset = recorded.create_dataset(  # type: ignore[attr-defined]
                    identifier, algorithm_name=algorithm, description=description
                )
            if dataset.total_episodes:
                self._move(identifier)
                self.written[identifier] = int(dataset.total_episodes)
        except OSError as error:
            raise unwritable(self._folder, error) from error

    def __enter__(self) -> Self:
        """Return the folder."""
        return self

    def __exit__(self, *_: object) -> None:
        """Remove what was begun and not kept."""
        self._begun.cleanup()

    def _free_identifier(self, recorded: gym.Env[Any, Any], agent: str | None) -> str:
        """Return an id of task, vehicle and agent, in the first version that the folder does not have."""
        inner = marine(recorded)
        task, vehicle = inner.definition.id.rpartition("-v")[0], inner.vehicle.name.replace("/", "-")
        last = "" if agent is None else "/" + agent.replace("/", "-")
        name, version = re.sub(r"[^-/\w]+", "-", f"{task}/{vehicle}{last}"), 0
        while (self._folder / f"{name}-v{version}").exists():
            version += 1
        return f"{name}-v{version}"

    def _move(self, identifier: str) -> None:
        """Let a dataset take its place, whole."""
        namespace = identifier.rpartition("/")[0]
        with self._datasets_in(str(self._folder)):
            if namespace not in self._minari.namespace.list_local_namespaces():
                self._minari.namespace.create_namespace(namespace)
        os.replace(Path(self._begun.name) / identifier, self._folder / identifier)

    @contextmanager
    def _datasets_in(self, folder: str) -> Iterator[None]:
        """Let Minari have its datasets in a folder, and say nothing of authors that it does not know."""
        before = os.environ.get(FOLDER_VARIABLE)
        os.environ[FOLDER_VARIABLE] = folder
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)
                yield
        finally:
            if before is None:
                del os.environ[FOLDER_VARIABLE]
            else:
                os.environ[FOLDER_VARIABLE] = before


class StepData:
    """Says what is kept of a step, as Minari's `StepDataCallback` does."""

    def __init__(self, notes: Callable[[bool], dict[str, Any]]) -> None:
        """Take what joins the info of a step or, where its argument is false, of a reset."""
        self._notes = notes

    def __call__(
        self,
        env: gym.Env[Any, Any],
        obs: Observation,
        info: dict[str, Any],
        action: Any = None,
        rew: float | None = None,
        terminated: bool | None = None,
        truncated: bool | None = None,
    ) -> dict[str, Any]:
        """Return a step's data: the action as it was held, and the info with its notes."""
        return {
            "action": None if action is None else np.clip(action, -1.0, 1.0),
            "observation": obs,
            "reward": rew,
            "terminated": terminated,
            "truncated": truncated,
            "info": info | self._notes(action is not None),
        }
