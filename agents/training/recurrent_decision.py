"""How a policy of recurrent PPO decides: its memory is given to it, and given back.

Unlike Stable-Baselines3's `predict` it can be traced, and for one observation it takes a quarter of the time.

Memory is a vector of numbers, all zero when an episode begins: the LSTM's output, then its cell.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.policies import BasePolicy
    from stable_baselines3.common.vec_env import VecNormalize
    from torch import Tensor, nn


class RecurrentDecision(nn.Module):
    """The most likely action, and one step of the LSTM (Hochreiter & Schmidhuber 1997), as torch's `nn.LSTM` has it.

    Attributes:
        memory_size: how many numbers it remembers.
    """

    def __init__(self, policy: Any) -> None:
        """Take a policy of recurrent PPO."""
        super().__init__()
        self._policy, self._lstm = policy, policy.lstm_actor
        self.memory_size = 2 * int(self._lstm.hidden_size)

    def forward(self, observations: Tensor | dict[str, Tensor], memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return actions and the new memory."""
        policy, lstm = self._policy, self._lstm
        seen: Tensor = BasePolicy.extract_features(policy, observations, policy.pi_features_extractor)
        output, cell = torch.chunk(memory, 2, dim=1)
        of_seen = nn.functional.linear(seen, lstm.weight_ih_l0, lstm.bias_ih_l0)
        of_output = nn.functional.linear(output, lstm.weight_hh_l0, lstm.bias_hh_l0)
        taken, kept, new, told = torch.chunk(of_seen + of_output, 4, dim=1)
        cell = torch.sigmoid(kept) * cell + torch.sigmoid(taken) * torch.tanh(new)
        output = torch.sigmoid(told) * torch.tanh(cell)
        return policy.action_net(policy.mlp_extractor.forward_actor(output)), torch.cat([output, cell], dim=1)


class RememberingPupil:
    """What a policy with a memory does by now, as an agent."""

    def __init__(self, policy: Any, envs: VecNormalize) -> None:
        """Take the policy and the environments that normalise what it sees."""
        self._policy, self._decision, self._envs = policy, RecurrentDecision(policy), envs
        self._nothing = torch.zeros(1, self._decision.memory_size)
        self._memory = self._nothing

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Forget the episode before."""
        self._memory = self._nothing

    def act(self, observation: Any) -> NDArray[np.float32]:
        """Return its most likely action."""
        seen = self._envs.normalize_obs(observation)
        given, _ = self._policy.obs_to_tensor(seen)
        with torch.no_grad():
            action, self._memory = self._decision(given, self._memory)
        limited: NDArray[np.float32] = np.clip(action[0].numpy(), -1.0, 1.0)
        return limited
