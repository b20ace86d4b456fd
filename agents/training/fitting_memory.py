"""Fitting a policy with a memory to what a teacher did, and its critic to what that earned.

Episodes are laid one after the other along streams, which are learned from side by side, piece by piece. What is
remembered at the end of a piece is where the next begins, but gradients go back to the piece's beginning only
(truncated backpropagation through time, Williams & Peng 1990, Neural Computation 2(4)).

Actions alone teach slowly what to remember. Where a teacher says what it has found out, such as where a partner is that
only ranges tell of, the memory is made to hold that, too: a layer, which is not kept, guesses it from the memory, as
auxiliary tasks do in Mirowski et al. 2017, Learning to navigate in complex environments, ICLR.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.settings import ImitationSettings
from dq_marine.agents.training.fitting import HELD_BACK, rates, rows_of, scaled_returns, terms_of_loss
from dq_marine.agents.training.teaching import Lessons
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from sb3_contrib.common.recurrent.policies import RecurrentActorCriticPolicy
    from stable_baselines3.common.policies import BasePolicy
    from stable_baselines3.common.vec_env import VecNormalize
    from torch import Tensor, nn

STREAMS = 16
"""Side by side: as many as make the products of matrices wide enough to be quick."""

LAST_RATE = 0.05
"""Of the learning rate at the end, over that at the beginning, where settings say no other."""

ESTIMATES_WEIGHT = 0.3
"""Of how far off the memory is what the teacher has found out, beside how far off the actions are."""

LARGEST_GRADIENT = 0.5
"""Its norm is cut there: far back along a piece it may grow without bound."""

State: TypeAlias = tuple[Tensor, Tensor] | None
"""What an LSTM remembers of each stream; None of nothing."""


class Piece(NamedTuple):
    """A piece of all streams.

    Attributes:
        rows: which control periods of the lessons, shape (periods, streams).
        flown: whether there is one, and not only what makes streams equally long; of the same shape.
        begins: 1 where an episode begins with the piece, else 0; shape (streams,).
    """

    rows: NDArray[np.int64]
    flown: NDArray[np.bool_]
    begins: NDArray[np.float32]


def fit_episodes(
    policy: RecurrentActorCriticPolicy,
    envs: VecNormalize,
    lessons: Lessons,
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> float:
    """Fit the policy to the actions and the critic to the returns; return how far actions held back are missed."""
    fitted = _Fitted(policy, envs, lessons)
    order = random.permutation(len(lessons.lengths))
    few = max(1, round(HELD_BACK * len(order))) if len(order) > 1 else 0
    held_back, learned = np.split(order, [few])
    periods = max(1, imitation.batch_size // STREAMS)
    optimiser = torch.optim.Adam(fitted.parameters, lr=imitation.learning_rate)
    policy.set_training_mode(True)
    for rate in rates(imitation, LAST_RATE):
        optimiser.param_groups[0]["lr"] = rate
        for loss in fitted.losses(random.permutation(learned), periods):
            optimiser.zero_grad()
            loss.backward()  # type: ignore[no-untyped-call]
            nn.utils.clip_grad_norm_(fitted.parameters, LARGEST_GRADIENT)
            optimiser.step()
    policy.set_training_mode(False)
    return fitted.missed(held_back if lessons.told_in(held_back) else order, periods)


class _Fitted:
    """What is learned from, as the policy sees it."""

    def __init__(self, policy: RecurrentActorCriticPolicy, envs: VecNormalize, lessons: Lessons) -> None:
        self._policy, self._lengths = policy, lessons.lengths
        self._observations, _ = policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
        self._actions = torch.as_tensor(lessons.actions)
        self._returns = scaled_returns(envs, lessons)
        spread = np.maximum(lessons.estimates.std(axis=0), 1e-6)
        self._estimates = torch.as_tensor((lessons.estimates - lessons.estimates.mean(axis=0)) / spread)
        known = lessons.estimates.shape[1]
        self._guess = nn.Linear(policy.lstm_actor.hidden_size, known) if known else None

    @property
    def parameters(self) -> list[nn.Parameter]:
        """All that is fitted: of the policy, and what guesses the teacher's estimates."""
        return [*self._policy.parameters(), *(self._guess.parameters() if self._guess else ())]

    def losses(self, episodes: NDArray[np.int64], periods: int) -> Iterator[Tensor]:
        """Yield the loss of one piece after the other."""
        actor: State = None
        critic: State = None
        for piece in pieces(self._lengths, episodes, periods):
            rows, flown = torch.as_tensor(piece.rows), torch.as_tensor(piece.flown)
            mean, remembered, actor = self._means(piece, actor)
            values, critic = self._values(piece, critic)
            terms = terms_of_loss(
                mean[flown], self._actions[rows][flown], values[flown], self._returns[rows][flown]
            )
            if self._guess is not None:
                off = (self._guess(remembered) - self._estimates[rows])[flown]
                terms.append(ESTIMATES_WEIGHT * torch.mean(off * off))
            if terms:
                yield sum(terms[1:], terms[0])

    def missed(self, episodes: NDArray[np.int64], periods: int) -> float:
        """Return the mean square difference of the actions in some episodes."""
        state: State = None
        total, count = 0.0, 0
        with torch.no_grad():
            for piece in pieces(self._lengths, episodes, periods):
                rows, flown = torch.as_tensor(piece.rows), torch.as_tensor(piece.flown)
                mean, _, state = self._means(piece, state)
                off = (mean - self._actions[rows])[flown]
                off = off[torch.isfinite(off)]
                total, count = total + float(torch.sum(off * off)), count + off.numel()
        return total / count

    def _means(self, piece: Piece, state: State) -> tuple[Tensor, Tensor, State]:
        """Return the actions' means, shape (periods, streams, axes), what they are of, and the state at the end."""
        policy = self._policy
        features = self._features(piece, policy.pi_features_extractor)
        remembered, state = _remembered(policy.lstm_actor, features, state, piece)
        return policy.action_net(policy.mlp_extractor.forward_actor(remembered)), remembered, state

    def _values(self, piece: Piece, state: State) -> tuple[Tensor, State]:
        """Return the critic's values, shape (periods, streams), and what it remembers at the end."""
        policy = self._policy
        features = self._features(piece, policy.vf_features_extractor)
        forgetful: Any = policy.critic
        if policy.lstm_critic is None:
            seen = forgetful(features)
        else:
            seen, state = _remembered(policy.lstm_critic, features, state, piece)
        return policy.value_net(policy.mlp_extractor.forward_critic(seen))[..., 0], state

    def _features(self, piece: Piece, extractor: Any) -> Tensor:
        """Return what a network sees, shape (periods, streams, features)."""
        seen = rows_of(self._observations, piece.rows.ravel())
        features = BasePolicy.extract_features(self._policy, seen, extractor)
        return features.reshape(*piece.rows.shape, -1)


def _remembered(lstm: nn.LSTM, features: Tensor, state: State, piece: Piece) -> tuple[Tensor, State]:
    """Return what an LSTM gives, and what it remembers; gradients do not go back beyond this piece."""
    if state is not None:
        kept = torch.as_tensor(1.0 - piece.begins)[:, None]
        state = (kept * state[0].detach(), kept * state[1].detach())
    found, state = lstm(features, state)
    return found, state


def pieces(lengths: NDArray[np.int64], episodes: NDArray[np.int64], periods: int) -> Iterator[Piece]:
    """Yield episodes piece by piece, each laid along the stream that is shortest by then.

    Args:
        lengths: of all episodes [control periods], shape (n,).
        episodes: which of them, and in which order.
        periods: of a piece. Episodes begin with one, so that the last of each may be filled up.
    """
    first = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    streams: list[list[tuple[int, int, bool]]] = [[] for _ in range(STREAMS)]
    for episode in episodes:
        shortest = min(streams, key=len)
        for start in range(0, int(lengths[episode]), periods):
            count = min(periods, int(lengths[episode]) - start)
            shortest.append((int(first[episode]) + start, count, start == 0))
    for number in range(max(map(len, streams))):
        rows = np.zeros((periods, STREAMS), np.int64)
        flown = np.zeros((periods, STREAMS), np.bool_)
        begins = np.ones(STREAMS, np.float32)
        for index, stream in enumerate(streams):
            if number < len(stream):
                start, count, new = stream[number]
                rows[:count, index] = np.arange(start, start + count)
                flown[:count, index] = True
                begins[index] = float(new)
        yield Piece(rows, flown, begins)
