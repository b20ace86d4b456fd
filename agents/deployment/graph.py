"""A trained policy as one graph: raw observations in, actions within their limits out.

It is what Stable-Baselines3's `predict(deterministic=True)` does behind `VecNormalize`, as a module that can be traced.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np

from dq_marine.agents.deployment.description import MEMORY, NEW_MEMORY
from dq_marine.agents.training.algorithms import Model
from dq_marine.agents.training.public_part import public_space
from dq_marine.agents.training.recurrent_decision import RecurrentDecision
from dq_marine.agents.training.symlog import SymlogNormalize
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("exporting a policy", "agents"):
    import torch
    from stable_baselines3.common.policies import ActorCriticPolicy, BasePolicy
    from stable_baselines3.common.vec_env import VecNormalize
    from stable_baselines3.td3.policies import TD3Policy
    from torch import Tensor, nn

EXPORTED = "ppo, sac, td3, tqc, crossq or recurrent_ppo"
"""Algorithms whose policies can be."""


class PolicyGraph(nn.Module):
    """Normalises, decides, and keeps within the limits.

    Attributes:
        input_names: of the arguments of `forward`, in their order.
        sizes: how many numbers each takes.
        output_names: of what it returns.
        memory_size: how many numbers it remembers from step to step; 0 for none.
    """

    _low: Tensor
    _high: Tensor

    def __init__(self, model: Model, normalisation: VecNormalize) -> None:
        """Take a model and the running normalisation of its observations; what only a critic saw is no input.

        Raises:
            InvalidInputError: the model decides in a way that this package does not train.
        """
        super().__init__()
        space = public_space(model.observation_space)
        spaces = dict(space.spaces) if isinstance(space, gym.spaces.Dict) else {"observation": space}
        self._seen_names = tuple(spaces)
        self._in_parts = isinstance(model.observation_space, gym.spaces.Dict)
        self._normalised = nn.ModuleList(_Normalised(normalisation, name, self._in_parts) for name in spaces)
        self._decided = _decision(model.policy)
        self.memory_size = int(getattr(self._decided, "memory_size", 0))
        remembered = (self.memory_size,) if self.memory_size else ()
        self.input_names = (*spaces, *((MEMORY,) if remembered else ()))
        self.sizes = (*(int(np.prod(one.shape or ())) for one in spaces.values()), *remembered)
        self.output_names = ("action", *((NEW_MEMORY,) if remembered else ()))
        action = model.action_space
        if not isinstance(action, gym.spaces.Box):
            raise InvalidInputError(f"actions are of {action}; export a policy whose actions are of a Box")
        self._squashed = bool(model.policy.squash_output)
        self.register_buffer("_low", torch.as_tensor(action.low))
        self.register_buffer("_high", torch.as_tensor(action.high))

    def forward(self, *given: Tensor) -> Tensor | tuple[Tensor, Tensor]:
        """Return actions, shape (batch, m), for raw observations, each of shape (batch, n).

        A policy that remembers is given its memory last, zeros when an episode begins, and gives the new one back.
        """
        if not self.memory_size:
            return self._limited(self._decided(self._seen(given)))
        *observations, memory = given
        decided, remembered = self._decided(self._seen(observations), memory)
        return self._limited(decided), remembered

    def _seen(self, observations: Sequence[Tensor]) -> Tensor | dict[str, Tensor]:
        """Return observations as the network takes them."""
        normalised = [one(raw) for one, raw in zip(self._normalised, observations, strict=True)]
        named = dict(zip(self._seen_names, normalised, strict=True))
        return named if self._in_parts else normalised[0]

    def _limited(self, decided: Tensor) -> Tensor:
        """Return actions within the space that they are of."""
        if self._squashed:  # within [-1, 1], to be stretched over the space, which round-off may leave
            decided = self._low + 0.5 * (decided + 1.0) * (self._high - self._low)
        return torch.maximum(torch.minimum(decided, self._high), self._low)


class _Normalised(nn.Module):
    """`VecNormalize.normalize_obs` of one input: in doubles, as NumPy does it there, so that nothing cancels."""

    _mean: Tensor
    _deviation: Tensor

    def __init__(self, normalisation: VecNormalize, name: str, in_parts: bool) -> None:
        super().__init__()
        self._clip = float(normalisation.clip_obs)
        self._symlog = isinstance(normalisation, SymlogNormalize)
        self._active = bool(normalisation.norm_obs)
        if in_parts and normalisation.norm_obs_keys is not None:
            self._active = self._active and name in normalisation.norm_obs_keys
        if self._active:
            both = normalisation.obs_rms
            running = both[name] if isinstance(both, dict) else both
            deviation = np.sqrt(running.var + normalisation.epsilon)
            self.register_buffer("_mean", torch.as_tensor(running.mean, dtype=torch.float64))
            self.register_buffer("_deviation", torch.as_tensor(deviation, dtype=torch.float64))

    def forward(self, raw: Tensor) -> Tensor:
        if not self._active:
            return raw
        told = raw.double()
        if self._symlog:
            told = torch.sign(told) * torch.log1p(torch.abs(told))
        return torch.clamp((told - self._mean) / self._deviation, -self._clip, self._clip).float()


class _PPODecision(nn.Module):
    """The most likely action, without the distribution round it, whose checks no exporter can trace."""

    def __init__(self, policy: ActorCriticPolicy) -> None:
        super().__init__()
        self._policy = policy

    def forward(self, observations: Tensor | dict[str, Tensor]) -> Tensor:
        policy = self._policy
        features: Tensor = BasePolicy.extract_features(policy, observations, policy.pi_features_extractor)
        mean: Tensor = policy.action_net(policy.mlp_extractor.forward_actor(features))
        return mean


class _SquashedDecision(nn.Module):
    """The same of an actor whose actions are squashed: SAC's, TQC's and CrossQ's."""

    def __init__(self, actor: Any) -> None:
        super().__init__()
        self._actor = actor

    def forward(self, observations: Tensor | dict[str, Tensor]) -> Tensor:
        mean, _, _ = self._actor.get_action_dist_params(observations)
        return torch.tanh(mean)


def _decision(policy: BasePolicy) -> nn.Module:
    if hasattr(policy, "lstm_actor"):
        return RecurrentDecision(policy)
    if isinstance(policy, ActorCriticPolicy):
        return _PPODecision(policy)
    if isinstance(policy, TD3Policy):
        return policy.actor
    actor = getattr(policy, "actor", None)
    if hasattr(actor, "get_action_dist_params"):
        return _SquashedDecision(actor)
    raise InvalidInputError(
        f"a policy of {type(policy).__name__} cannot be exported; export one of {EXPORTED}"
    )
