"""How a policy of recurrent PPO decides, as a module that can be traced: its memory is given to it, and given back.

Memory is a vector of numbers, all zero when an episode begins: the LSTM's output, then its cell.
"""

from __future__ import annotations

from typing import Any

from dq_marine.util.extras import extra_needed

with extra_needed("exporting a policy", "agents"):
    import torch
    from stable_baselines3.common.policies import BasePolicy
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
