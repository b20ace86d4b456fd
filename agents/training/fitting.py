"""Fitting a policy without a memory to what a teacher did, and its critic to what that earned."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.settings import ImitationSettings
from dq_marine.agents.training.teaching import Lessons
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.policies import ActorCriticPolicy
    from stable_baselines3.common.vec_env import VecNormalize

HELD_BACK = 0.1
"""Share of what was flown that is not learned from, but tells how well the rest was."""


def fit_steps(
    policy: ActorCriticPolicy,
    envs: VecNormalize,
    lessons: Lessons,
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> float:
    """Fit the policy to the actions and the critic to the returns; return how far actions held back are missed."""
    observations, _ = policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    actions = torch.as_tensor(lessons.actions)
    returns = scaled_returns(envs, lessons)

    def terms(batch: NDArray[np.int64]) -> list[torch.Tensor]:
        mean, values = _foretold(policy, rows_of(observations, batch))
        return terms_of_loss(mean, actions[batch], values, returns[batch])

    held_back = learn_in_batches(policy, len(actions), terms, imitation, random)
    looked_at = with_actions(held_back, lessons)
    with torch.no_grad():
        mean, _ = _foretold(policy, rows_of(observations, looked_at))
        return float(torch.nn.functional.mse_loss(mean, actions[looked_at]))


def learn_in_batches(
    network: torch.nn.Module,
    count: int,
    terms: Callable[[NDArray[np.int64]], list[torch.Tensor]],
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> NDArray[np.int64]:
    """Let a network make terms small, over rows in batches.

    Args:
        network: whose parameters are fitted: a policy, or its actor or critics alone.
        count: of the rows.
        terms: of the loss for some rows; none where nothing of these is known.
        imitation: how often they are gone through, in batches of which size, and at which rate.
        random: their order.

    Returns:
        The rows that were held back.
    """
    held_back, learned = np.split(random.permutation(count), [max(1, round(HELD_BACK * count))])
    optimiser = torch.optim.Adam(network.parameters(), lr=imitation.learning_rate)
    network.train()
    for rate, batch in _batches(learned, imitation, random):
        optimiser.param_groups[0]["lr"] = rate
        found = terms(batch)
        if not found:
            continue
        optimiser.zero_grad()
        sum(found[1:], found[0]).backward()  # type: ignore[no-untyped-call]
        optimiser.step()
    network.eval()
    return held_back


def with_actions(rows: NDArray[np.int64], lessons: Lessons) -> NDArray[np.int64]:
    """Return those of the rows whose actions are learned from, or all such where none of these is one."""
    told = rows[np.isfinite(lessons.actions[rows, 0])]
    return told if len(told) else np.flatnonzero(np.isfinite(lessons.actions[:, 0]))


def _batches(
    rows: NDArray[np.int64], imitation: ImitationSettings, random: np.random.Generator
) -> Iterator[tuple[float, NDArray[np.int64]]]:
    """Yield the rows in batches, in another order in each epoch, each with the learning rate."""
    for rate in rates(imitation, 1.0):
        order = random.permutation(rows)
        for start in range(0, len(order), imitation.batch_size):
            yield rate, order[start : start + imitation.batch_size]


def rates(imitation: ImitationSettings, last_share: float) -> Iterator[float]:
    """Yield the learning rate of each epoch; where settings say no other, the last is so large a share of the first."""
    first, final = imitation.learning_rate, imitation.final_learning_rate
    for share in np.linspace(1.0, last_share if final is None else final / first, imitation.epochs):
        yield float(share) * first


def scaled_returns(envs: VecNormalize, lessons: Lessons) -> torch.Tensor:
    """Return the returns as the critic is to tell them: of rewards as the environments normalise them."""
    scale = np.sqrt(envs.ret_rms.var + envs.epsilon) if envs.norm_reward else 1.0
    return torch.as_tensor(np.asarray(lessons.returns / scale, dtype=np.float32))


def terms_of_loss(
    mean: torch.Tensor, actions: torch.Tensor, values: torch.Tensor, returns: torch.Tensor
) -> list[torch.Tensor]:
    """Return by how much actions and returns are missed, of each what is known; nothing of what is not known at all.

    Args:
        mean: of the policy's actions, shape (n, axes).
        actions: of the teacher, likewise; NaN where they are not learned from.
        values: of the critic, shape (n,).
        returns: likewise; NaN where too little of them was flown.
    """
    told, known = torch.isfinite(actions[:, 0]), torch.isfinite(returns)
    pairs = ((mean[told], actions[told]), (values[known], returns[known]))
    return [torch.nn.functional.mse_loss(guess, right) for guess, right in pairs if len(right)]


def rows_of(observations: Any, rows: NDArray[np.int64]) -> Any:
    """Return some rows of observations, or of each of their parts."""
    if isinstance(observations, dict):
        return {name: values[rows] for name, values in observations.items()}
    return observations[rows]


def _foretold(policy: ActorCriticPolicy, observations: Any) -> tuple[torch.Tensor, torch.Tensor]:
    """Return the mean of the actions, shape (n, axes), and the critic's values, shape (n,)."""
    distribution: Any = policy.get_distribution(observations).distribution  # torch's normal one, not SB3's
    return distribution.mean, policy.predict_values(observations).flatten()
