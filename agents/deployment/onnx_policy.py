"""An exported policy as an agent: by onnxruntime alone, without torch and Stable-Baselines3."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.deployment.description import MEMORY, METADATA_KEY, PolicyDescription
from dq_marine.agents.deployment.seal import has_seal, is_whole
from dq_marine.agents.environments import marine
from dq_marine.checks import existing_file, shown
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import optional_library

ENDING = ".onnx"
"""Of the names of files that hold a policy."""

FATAL = 4
"""onnxruntime's level of a message that it writes to standard error; what is less is raised as an error, too."""


class OnnxPolicy:
    """A policy that `dq-marine export` wrote.

    The file is data: a graph of arithmetic and a description as JSON. Unlike a training run, nothing of it is
    unpickled or run as code.

    Attributes:
        description: what the policy was trained in and with, what it reads and what its actions mean.
    """

    def __init__(self, path: Path) -> None:
        """Load a file.

        Raises:
            InvalidInputError: it is missing, damaged, or no policy that this package exported.
            MissingDependencyError: onnxruntime is not installed.
        """
        content = policy_bytes(path)
        runtime = optional_library("flying an exported policy", "onnxruntime", "deploy")
        options = runtime.SessionOptions()
        options.intra_op_num_threads = 1  # networks this small wait longer for a thread than they compute
        options.log_severity_level = FATAL
        try:
            self._session = runtime.InferenceSession(content, options, providers=["CPUExecutionProvider"])
        except (
            Exception
        ) as error:  # of onnxruntime: each kind of failure has a class of its own, derived from Exception
            raise InvalidInputError(
                f"onnxruntime cannot load {path}: {shown(error)}; export it anew with `dq-marine export`"
            ) from error
        metadata = self._session.get_modelmeta().custom_metadata_map
        self.description = PolicyDescription.read(metadata.get(METADATA_KEY, ""), source=str(path))
        self._inputs = self.description.inputs
        self._memory: NDArray[np.float32] | None = None
        self._check_graph(path)

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Check that the policy fits the environment, and forget the episode before, if it remembers.

        Raises:
            InvalidInputError: the environment's observations or actions are not those that it was trained on.
        """
        differing = self.description.differences(marine(env))
        if differing:
            raise InvalidInputError(
                f"the policy was trained in {self.description.environment.id} with {self.description.vehicle}; this "
                f"environment has {'; '.join(differing)}; fly it with the task, vehicle and sensors of its training"
            )
        self._memory = None

    def act(self, observation: Observation) -> Action:
        """Return the most likely action, shape (m,); for observations of shape (batch, n), (batch, m).

        What it remembers is of the steps since `reset`, or since the batch was of another size.
        """
        parts = observation if isinstance(observation, dict) else {next(iter(self._inputs)): observation}
        single = next(iter(parts.values())).ndim == 1
        feeds = {name: np.atleast_2d(np.asarray(parts[name], np.float32)) for name in self._inputs}
        if self.description.memory:
            count = len(next(iter(feeds.values())))
            if self._memory is None or len(self._memory) != count:
                self._memory = np.zeros((count, self.description.memory), np.float32)
            feeds[MEMORY] = self._memory
        actions: Action
        actions, *remembered = self._session.run(None, feeds)
        self._memory = remembered[0] if remembered else None
        return actions[0] if single else actions

    def _check_graph(self, path: Path) -> None:
        """Check that the graph takes and gives what the description says."""
        found = {one.name: one.shape[1:] for one in self._session.get_inputs()}
        given = [one.shape[1:] for one in self._session.get_outputs()]
        memory = self.description.memory
        inputs = {name: [size] for name, size in self._inputs.items()} | (
            {MEMORY: [memory]} if memory else {}
        )
        outputs = [[len(self.description.actions)], *([[memory]] if memory else [])]
        if found != inputs or given != outputs:
            raise InvalidInputError(
                f"{path} holds a graph from {found} to {given}, which is not what its description says; export it anew "
                "with `dq-marine export`"
            )


def policy_bytes(path: Path) -> bytes:
    """Return the content of a file that holds a policy, as it was written.

    Raises:
        InvalidInputError: there is no such file, or it is damaged, or another kind of file.
    """
    file = existing_file("policy", path)
    if file is None:
        raise InvalidInputError(
            f"there is no file {path}; give one that `dq-marine export` wrote, or a run's folder"
        )
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InvalidInputError(f"{path} cannot be read: {error.strerror}; let yourself read it") from error
    if not has_seal(content):
        raise InvalidInputError(
            f"{path} is no policy that dq-marine exported, or only the beginning of one; write one with "
            "`dq-marine export RUN --out policy.onnx`"
        )
    if not is_whole(content):
        raise InvalidInputError(
            f"{path} is damaged: it is not as `dq-marine export` wrote it; restore it from a copy, or export it anew"
        )
    return content
