"""The policies of sb3-contrib whose critic sees the whole observation: see `privileged_policies`."""

from __future__ import annotations

from typing import Any

from dq_marine.agents.training.privileged_policies import PublicActor, seen_apart
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from sb3_contrib.common.recurrent.policies import RecurrentMultiInputActorCriticPolicy
    from sb3_contrib.tqc.policies import MultiInputPolicy as TQCMultiInputPolicy
    from stable_baselines3.common.torch_layers import CombinedExtractor
    from torch import nn


class PrivilegedRecurrentPPOPolicy(RecurrentMultiInputActorCriticPolicy):
    """Recurrent PPO's: both networks remember, each what it sees."""

    def __init__(self, observation_space: Any, action_space: Any, lr_schedule: Any, **keywords: Any) -> None:
        """Take what recurrent PPO's own policy takes; what the networks see is fixed."""
        super().__init__(observation_space, action_space, lr_schedule, **seen_apart(keywords))
        remembered = self.lstm_actor
        self.vf_features_extractor = CombinedExtractor(observation_space)
        self.lstm_critic = nn.LSTM(
            self.vf_features_extractor.features_dim,
            remembered.hidden_size,
            num_layers=remembered.num_layers,
            **self.lstm_kwargs,
        )
        rate = {"lr": lr_schedule(1)}
        self.optimizer = self.optimizer_class(self.parameters(), **rate, **self.optimizer_kwargs)


class PrivilegedTQCPolicy(PublicActor, TQCMultiInputPolicy):  # type: ignore[misc]
    """TQC's."""
