"""What was flown, as Minari datasets: one for each environment, with all its episodes.

Each step's info has `by_person`, whether the person was at the helm: an imitation of them may leave out the rest; and
`pushed`, whether they pulled the vehicle by hand: what it did then does not follow from its action alone.
"""

from __future__ import annotations

import os
import re
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.environments import marine
from dq_marine.envs.core.observation import Observation
from dq_marine.util.extras import optional_library
from dq_marine.util.files import unwritable

PURPOSE, EXTRA = "recording flights", "interop"

FOLDER_VARIABLE = "MINARI_DATASETS_PATH"
"""Where Minari looks for the folder of its datasets."""

BY_PERSON, PUSHED = "by_person", "pushed"


class Recorder(AbstractContextManager["Recorder"]):
    """Keeps what is flown in a folder of Minari datasets.

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
        self._folder = folder
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._begun = tempfile.TemporaryDirectory(dir=folder, prefix=".recording-")
        except OSError as error:
            raise unwritable(folder, error) from error

    def recording(
        self, env: gym.Env[Any, Any], by_person: Callable[[], bool], pushed: Callable[[], bool]
    ) -> gym.Env[Any, Any]:
        """Return an environment around one of this package that keeps what is flown in it.

        Args:
            env: whose episodes are kept.
            by_person: whether a person flies it now.
            pushed: whether a person pulled it by hand in the last step.
        """
        with self._datasets_in(self._begun.name):
            collector: gym.Env[Any, Any] = self._minari.DataCollector(
                env, step_data_callback=lambda: StepData(by_person, pushed), record_infos=True
            )
        return collector

    def keep(self, recorded: gym.Env[Any, Any]) -> None:
        """Write the episodes of an environment that `recording` returned, if any, as one dataset.

        Raises:
            InvalidInputError: it cannot be written.
        """
        identifier = self._free_identifier(recorded)
        try:
            with self._datasets_in(self._begun.name):
                dataset = recorded.create_dataset(  # type: ignore[attr-defined]
                    identifier,
                    algorithm_name="flown in the live page",
                    description=(
                        f"flown in the live page of dq-marine; {BY_PERSON} tells who was at the helm, {PUSHED} in "
                        "which steps the vehicle was pulled by hand"
                    ),
                )
            if dataset.total_episodes:
                self._move(identifier)
                self.written[identifier] = int(dataset.total_episodes)
        except OSError as error:
            raise unwritable(self._folder, error) from error

    def __exit__(self, *_: object) -> None:
        """Remove what was begun and not kept."""
        self._begun.cleanup()

    def _free_identifier(self, recorded: gym.Env[Any, Any]) -> str:
        """Return an id of task and vehicle, in the first version that the folder does not have."""
        inner = marine(recorded)
        task, vehicle = inner.definition.id.rpartition("-v")[0], inner.vehicle.name.replace("/", "-")
        name, version = re.sub(r"[^-/\w]+", "-", f"{task}/{vehicle}"), 0
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

    def __init__(self, by_person: Callable[[], bool], pushed: Callable[[], bool]) -> None:
        """Take what tells whether a person flies, and whether they pulled the vehicle in the last step."""
        self._by_person, self._pushed = by_person, pushed

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
        """Return a step's data: the action as it was held, who gave it, and whether the vehicle was pushed besides."""
        pushed = action is not None and self._pushed()  # a reset is no step
        return {
            "action": None if action is None else np.clip(action, -1.0, 1.0),
            "observation": obs,
            "reward": rew,
            "terminated": terminated,
            "truncated": truncated,
            "info": {**info, BY_PERSON: self._by_person(), PUSHED: pushed},
        }
