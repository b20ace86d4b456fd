"""Stable-Baselines3's policies with a critic that sees the whole observation, and an actor that does not.

The actor takes every part but the privileged one (`public_part`), so that it flies where there is none. This is the
asymmetric actor-critic of Pinto et al. 2017 (arXiv:1710.06542): the critic only guides the learning.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from dq_marine.agents.training.public_part import public_parts
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.policies import MultiInputActorCriticPolicy
    from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, CombinedExtractor, MlpExtractor
    from stable_baselines3.sac.policies import MultiInputPolicy as SACMultiInputPolicy
    from stable_baselines3.td3.policies import MultiInputPolicy as TD3MultiInputPolicy


class PublicExtractor(CombinedExtractor):
    """Joins the parts of an observation but for the privileged one."""

    def __init__(self, observation_space: gym.spaces.Dict) -> None:
        """Take the space of the whole observation."""
        super().__init__(public_parts(observation_space))


def seen_apart(keywords: dict[str, Any]) -> dict[str, Any]:
    """Return the keywords of a policy whose actor sees the public parts, and whose critic has eyes of its own."""
    return keywords | {"features_extractor_class": PublicExtractor, "share_features_extractor": False}


class PrivilegedPPOPolicy(MultiInputActorCriticPolicy):
    """PPO's."""

    observation_space: gym.spaces.Dict

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        """Take what PPO's own policy takes; what the networks see is fixed."""
        super().__init__(*arguments, **seen_apart(keywords))

    def _build_mlp_extractor(self) -> None:
        """Make both networks, the critic's as wide at its entrance as the whole observation."""
        super()._build_mlp_extractor()
        self.vf_features_extractor = CombinedExtractor(self.observation_space)
        wide = MlpExtractor(
            self.vf_features_extractor.features_dim, self.net_arch, self.activation_fn, self.device
        )
        self.mlp_extractor.value_net = wide.value_net


class PublicActor:
    """What makes a policy's actor, of algorithms with a replay buffer, see the public parts alone."""

    observation_space: gym.spaces.Dict

    def make_actor(self, features_extractor: BaseFeaturesExtractor | None = None) -> Any:
        """Return an actor, or a target of one."""
        own = PublicExtractor(self.observation_space) if features_extractor is None else features_extractor
        return super().make_actor(own)  # type: ignore[misc]


class PrivilegedSACPolicy(PublicActor, SACMultiInputPolicy):  # type: ignore[misc]
    """SAC's."""


class PrivilegedTD3Policy(PublicActor, TD3MultiInputPolicy):  # type: ignore[misc]
    """TD3's."""
