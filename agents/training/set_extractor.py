"""A network that reads several things of a kind alike, such as the vessels of an encounter, whichever number they have.

Each thing is read by the same layers, together with all that is not numbered; what they make of the things is joined
by its maximum and its mean, so that exchanging two of them changes nothing (Zaheer et al. 2017, Deep Sets, NeurIPS).
A policy so need not learn for each number anew what it has learned for one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym

from dq_marine.agents.training.numbered_things import Places, check_one_part
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, create_mlp
    from torch import Tensor, nn


class SetExtractor(BaseFeaturesExtractor):
    """Reads what is not numbered as it is, and things of each kind by layers of their own."""

    def __init__(
        self,
        observation_space: gym.Space[Any],
        alone: Places,
        kinds: list[list[Places]],
        layers: Sequence[int],
        activation: type[nn.Module],
    ) -> None:
        """Take the space of observations, what `things_of` returns, and the layers that read a thing.

        Raises:
            InvalidInputError: observations come in parts.
        """
        check_one_part(observation_space)
        super().__init__(observation_space, len(alone) + 2 * layers[-1] * len(kinds))
        self._alone, self._kinds = alone, kinds
        self._readers = nn.ModuleList(
            nn.Sequential(*create_mlp(len(alone) + len(things[0]), -1, list(layers), activation))
            for things in kinds
        )

    def forward(self, observations: Tensor) -> Tensor:
        """Return what is not numbered, then the maximum and the mean over the things of each kind."""
        alone = observations[:, self._alone]
        features = [alone]
        for things, reader in zip(self._kinds, self._readers, strict=True):
            read = torch.stack([reader(torch.cat([alone, observations[:, one]], dim=1)) for one in things])
            features += [read.amax(dim=0), read.mean(dim=0)]
        return torch.cat(features, dim=1)
