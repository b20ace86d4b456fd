"""The learning algorithms: which class of Stable-Baselines3 or of sb3-contrib, and what it is told."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from dq_marine.agents.algorithm_settings import (
    AlgorithmSettings,
    CrossQSettings,
    RecurrentPPOSettings,
    RolloutSettings,
    TD3Settings,
)
from dq_marine.agents.environments import space_shape
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.numbered_things import things_of
from dq_marine.agents.training.set_extractor import SetExtractor
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import stable_baselines3
    import torch
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.noise import NormalActionNoise

Model: TypeAlias = BaseAlgorithm

OWN = {"ppo": "PPO", "sac": "SAC", "td3": "TD3"}
"""Names of algorithms, and what Stable-Baselines3 calls their classes."""

OF_CONTRIB = {"recurrent_ppo": "RecurrentPPO", "tqc": "TQC", "crossq": "CrossQ"}
"""The same of sb3-contrib."""

PRIVILEGED_POLICIES = {
    "ppo": ("privileged_policies", "PrivilegedPPOPolicy"),
    "sac": ("privileged_policies", "PrivilegedSACPolicy"),
    "td3": ("privileged_policies", "PrivilegedTD3Policy"),
    "recurrent_ppo": ("privileged_contrib_policies", "PrivilegedRecurrentPPOPolicy"),
    "tqc": ("privileged_contrib_policies", "PrivilegedTQCPolicy"),
}
"""Modules and classes of policies with a privileged critic, by algorithm; those of sb3-contrib stand apart."""

ACTIVATIONS = {"tanh": torch.nn.Tanh, "relu": torch.nn.ReLU}


@dataclass(frozen=True)
class LinearSchedule:
    """A learning rate that falls linearly from `first` to `last`; a class of ours, so that it can be pickled."""

    first: float
    last: float

    def __call__(self, progress_remaining: float) -> float:
        """Return the rate; `progress_remaining` falls from 1 to 0, and below in a last rollout that goes beyond."""
        return self.last + (self.first - self.last) * max(0.0, progress_remaining)


def model_class(name: str) -> type[Model]:
    """Return the class of an algorithm.

    Raises:
        MissingDependencyError: the algorithm is of sb3-contrib, which is not installed.
    """
    if name in OWN:
        own: type[Model] = getattr(stable_baselines3, OWN[name])
        return own
    with extra_needed(f"training by {name}", "agents"):
        import sb3_contrib
    of_contrib: type[Model] = getattr(sb3_contrib, OF_CONTRIB[name])
    return of_contrib


def policy_name(algorithm: AlgorithmSettings, *, goals: bool) -> str:
    """Return what the library calls the policy, for observations with or without goals.

    Raises:
        InvalidInputError: the algorithm takes no goals.
    """
    if goals and isinstance(algorithm, CrossQSettings):
        raise InvalidInputError(
            "crossq takes no observations with goals; train with another algorithm, or leave goals out of the "
            "environment"
        )
    memory = "Lstm" if isinstance(algorithm, RecurrentPPOSettings) else ""
    return ("MultiInput" if goals else "Mlp") + memory + "Policy"


def privileged_policy(algorithm: AlgorithmSettings) -> type[Any]:
    """Return the policy whose critic sees what only the simulator knows.

    Raises:
        MissingDependencyError: the algorithm is of sb3-contrib, which is not installed.
    """
    module, name = PRIVILEGED_POLICIES[algorithm.name]
    found: type[Any] = getattr(importlib.import_module(f"dq_marine.agents.training.{module}"), name)
    return found


def keywords_of(settings: TrainingSettings, env: MarineEnv) -> dict[str, Any]:
    """Return the keywords of the algorithm's class that its settings and those of its network come to.

    Args:
        settings: of the training.
        env: one of the environments.

    Raises:
        InvalidInputError: layers that read numbered things alike are asked for, and the environment shows none.
    """
    algorithm, network = settings.algorithm, settings.network
    given = algorithm.model_dump(exclude={"name"})
    policy = {name: given.pop(name) for name in algorithm.OF_THE_POLICY}
    activation = ACTIVATIONS[network.activation]
    policy |= {"net_arch": list(network.layers), "activation_fn": activation}
    if network.set_layers:
        alone, kinds = things_of(env.observations)
        policy |= {
            "share_features_extractor": False,  # what the critic reads out of them would cost the actor's exactness
            "features_extractor_class": SetExtractor,
            "features_extractor_kwargs": {
                "alone": alone,
                "kinds": kinds,
                "layers": network.set_layers,
                "activation": activation,
            },
        }
    given["learning_rate"] = LinearSchedule(given["learning_rate"], given.pop("final_learning_rate"))
    if isinstance(algorithm, RolloutSettings):
        given["batch_size"] = settings.envs * algorithm.n_steps // given.pop("minibatches")
    if isinstance(algorithm, TD3Settings):
        deviation = np.full(space_shape(env.action_space), given.pop("exploration_noise"))
        given["action_noise"] = NormalActionNoise(np.zeros_like(deviation), deviation)
    return {**given, "policy_kwargs": policy}
