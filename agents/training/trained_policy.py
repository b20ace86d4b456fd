"""A policy that was trained with Stable-Baselines3, as an agent."""

from __future__ import annotations

import pickle
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.environments import space_shape
from dq_marine.agents.training.algorithms import model_class
from dq_marine.agents.training.learners import refusing_damage
from dq_marine.agents.training.public_part import as_seen_by_actor, normalise_public_alone, public_space
from dq_marine.agents.training.run_folder import MODEL_FILE, NORMALISATION_FILE, RunFolder
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError


class TrainedPolicy:
    """The best model of a run (the latest, if none was evaluated yet), without exploration.

    SB3's model.zip and normalisation.pkl are unpickled, which runs whatever code they hold: load only runs that
    you trust.
    """

    def __init__(self, folder: RunFolder) -> None:
        """Load model and normalisation.

        Raises:
            InvalidInputError: there is no run in the folder, it has saved no model yet, or what it saved is damaged.
            MissingDependencyError: Stable-Baselines3 is not installed.
        """
        self.settings = folder.read_plan().settings
        snapshot = folder.trained_snapshot
        algorithm = model_class(self.settings.algorithm.name)
        with refusing_damage(snapshot):
            self.model = algorithm.load(snapshot / MODEL_FILE, device="cpu")
            self.normalisation = pickle.loads((snapshot / NORMALISATION_FILE).read_bytes())  # noqa: S301 - said above
        normalise_public_alone(self.normalisation)
        self._memory: tuple[NDArray[Any], ...] | None = None

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Check that the policy fits the environment, and forget the episode before, if the policy remembers.

        Raises:
            InvalidInputError: it was trained on other observations or actions.
        """
        for name, trained, found in (
            (
                "observation",
                public_space(self.model.observation_space),
                public_space(env.observation_space),
            ),
            ("action", self.model.action_space, env.action_space),
        ):
            if space_shape(trained) != space_shape(found):
                raise InvalidInputError(
                    f"the policy was trained with {name} shape {space_shape(trained)}, the environment has "
                    f"{space_shape(found)}; "
                    "fly it with the task and vehicle that it was trained with"
                )
        self._memory = None

    def act(self, observation: Observation) -> Action:
        """Return the most likely action, shape (n,)."""
        public = as_seen_by_actor(self.model.observation_space, observation)
        seen = self.normalisation.normalize_obs(public)
        action, self._memory = self.model.predict(seen, state=self._memory, deterministic=True)
        return np.asarray(action, dtype=np.float32)
