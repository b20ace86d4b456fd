"""Fitting what learns from all it remembers, such as SAC: the actor to a teacher, critics to what was earned."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.settings import ImitationSettings
from dq_marine.agents.training.fitting import (
    learn_in_batches,
    rows_of,
    scaled_returns,
    with_actions,
)
from dq_marine.agents.training.teaching import Lessons
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
    from stable_baselines3.common.vec_env import VecNormalize
    from stable_baselines3.sac.policies import LOG_STD_MIN
    from torch.nn.functional import mse_loss

TARGETS = ("actor", "critic")
"""Networks that some algorithms keep slow copies of, named with `_target`."""


def fit_actor(
    policy: Any,
    envs: VecNormalize,
    lessons: Lessons,
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> float:
    """Fit the actor of SAC, TD3, TQC or CrossQ to what the teacher would do; return how far it is off.

    An actor that draws its actions comes to draw them as widely as the teacher's were disturbed.
    """
    observations, _ = policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    actions = torch.as_tensor(lessons.actions)
    log_std = math.log(imitation.noise) if imitation.noise else LOG_STD_MIN

    def terms(batch: NDArray[np.int64]) -> list[torch.Tensor]:
        told = batch[np.isfinite(lessons.actions[batch, 0])]
        if not len(told):
            return []
        done, spread = acted(policy.actor, rows_of(observations, told))
        missed = mse_loss(done, actions[told])
        return [missed] if spread is None else [missed, mse_loss(spread, torch.full_like(spread, log_std))]

    held_back = learn_in_batches(policy.actor, len(actions), terms, imitation, random)
    looked_at = with_actions(held_back, lessons)
    with torch.no_grad():
        done, _ = acted(policy.actor, rows_of(observations, looked_at))
        return float(mse_loss(done, actions[looked_at]))


def fit_critics(
    model: OffPolicyAlgorithm,
    envs: VecNormalize,
    lessons: Lessons,
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> None:
    """Fit the critics of SAC, TD3, TQC or CrossQ to the returns of what was done; slow copies follow at once."""
    policy: Any = model.policy
    observations, _ = policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    flown, returns = torch.as_tensor(lessons.flown), scaled_returns(envs, lessons)

    def terms(batch: NDArray[np.int64]) -> list[torch.Tensor]:
        known = batch[np.isfinite(lessons.returns[batch])]
        if not len(known):
            return []
        told = values(policy, rows_of(observations, known), flown[known])
        return [_missed(one, returns[known]) for one in told]

    learn_in_batches(policy.critic, len(returns), terms, imitation, random)
    for name in TARGETS:
        if hasattr(policy, f"{name}_target"):
            getattr(policy, f"{name}_target").load_state_dict(getattr(policy, name).state_dict())


def acted(actor: Any, observations: Any) -> tuple[torch.Tensor, torch.Tensor | None]:
    """Return an actor's most likely actions, and the logarithm of how widely it draws them; None if it draws none."""
    if not hasattr(actor, "get_action_dist_params"):
        return actor(observations), None
    mean, log_std, _ = actor.get_action_dist_params(observations)
    return torch.tanh(mean), log_std


def values(policy: Any, observations: Any, actions: torch.Tensor) -> tuple[torch.Tensor, ...]:
    """Return what each critic says: shape (n, 1), or (n, quantiles)."""
    told = policy.critic(observations, actions)
    return told if isinstance(told, tuple) else told.unbind(1)


def _missed(told: torch.Tensor, earned: torch.Tensor) -> torch.Tensor:
    """Return by how much a critic misses the returns: their mean, or each quantile its share of them."""
    if told.shape[1] == 1:
        return mse_loss(told[:, 0], earned)
    from sb3_contrib.common.utils import quantile_huber_loss  # here: only its critics tell quantiles

    return quantile_huber_loss(told, earned[:, None], sum_over_quantiles=False)
