"""A network that reads several things of a kind alike, such as the vessels of an encounter, whichever number they have.

Each thing is read by the same layers, together with all that is not numbered; what they make of the things is joined
by its maximum and its mean, so that exchanging two of them changes nothing (Zaheer et al. 2017, Deep Sets, NeurIPS).
A policy so need not learn for each number anew what it has learned for one.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym

from dq_marine.agents.environments import space_shape
from dq_marine.envs.core.definition import Observed
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, create_mlp
    from torch import Tensor, nn

NUMBERED = re.compile(r"(?P<kind>\w+?)_(?P<number>\d+)_(?P<what>\w+)")
"""Names of parts of things that are numbered, such as vessel_2_course_level."""

Places = list[int]


def things_of(observations: Iterable[Observed]) -> tuple[Places, list[list[Places]]]:
    """Return where, in an observation, is what is not numbered; and of each kind of things where each of them is.

    Raises:
        InvalidInputError: nothing is numbered, or two things of a kind are shown differently.
    """
    alone: Places = []
    kinds: dict[str, dict[str, list[tuple[str, int]]]] = {}
    places = itertools.count()
    for one in observations:
        own = list(itertools.islice(places, one.size))
        found = NUMBERED.fullmatch(one.name)
        if found is None:
            alone += own
        else:
            thing = kinds.setdefault(found["kind"], {}).setdefault(found["number"], [])
            thing += [(found["what"], place) for place in own]
    if not kinds:
        raise InvalidInputError(
            "network.set_layers read things that are numbered in an observation, such as vessel_1_rules and "
            "vessel_2_rules, and this environment shows none; leave set_layers out"
        )
    for kind, things in kinds.items():
        if len({tuple(what for what, _ in thing) for thing in things.values()}) > 1:
            raise InvalidInputError(
                f"network.set_layers read each {kind} alike, and {', '.join(things)} are shown differently; leave "
                "set_layers out"
            )
    return alone, [[[place for _, place in thing] for thing in things.values()] for things in kinds.values()]


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
        if not isinstance(observation_space, gym.spaces.Box):
            raise InvalidInputError(
                "network.set_layers read observations of one part, and these have "
                f"{list(space_shape(observation_space))}; leave set_layers out, or goals out of the environment"
            )
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
