"""What a teacher would do where it or its pupil flies, and what that earns.

The teacher's actions are disturbed while it flies, so that the pupil sees how one comes back from where the teacher by
itself would never be (Laskey et al. 2017, DART, CoRL). In further rounds the pupil flies itself, and is told what the
teacher would have done there (Ross et al. 2011, DAgger, AISTATS); or both fly in turns, and what the teacher does is
told only while it flies (Kelly et al. 2019, HG-DAgger, ICRA), because a teacher that integrates errors which another
leaves ends up doing nothing else but that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.baselines import Agent, estimate_of, make_baseline
from dq_marine.agents.environments import make_environment, space_shape
from dq_marine.agents.noise import with_noise
from dq_marine.agents.settings import ImitationSettings, TrainingSettings
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.policies import BasePolicy
    from stable_baselines3.common.vec_env import VecNormalize

TEACHING_SEED = 3_000_000
"""Of the teacher's first episode: far from the seeds that training counts up from, and from those of evaluations."""

FORESIGHT = 3.0
"""Of the discounted return of an episode that the time limit cuts off, that from so many times 1/(1 - gamma) before the
end is whole but for exp(-3) of it: later ones teach the critic nothing."""

Observations = NDArray[np.float32] | dict[str, NDArray[np.float32]]


@dataclass(frozen=True)
class Lessons:
    """What a teacher flew: n control periods.

    Attributes:
        observations: at their beginnings, shape (n, observed), or that for each part of an observation with goals.
        actions: what the teacher would have done, shape (n, axes); NaN where it is not learned from.
        returns: discounted, from each on, shape (n,); NaN where too little of it was flown.
        running: what `VecNormalize` sums up of rewards, by which it divides them, shape (n,).
        lengths: of the episodes, one after the other [control periods].
        estimates: what the teacher has found out that no observation shows, shape (n, k); k is 0 if it tells of none.
        flown: what was done, disturbed, shape (n, axes).
        rewards: for it, shape (n,).
        ends: observations that episodes ended with, one for each, like `observations`.
        terminated: whether an episode ended by itself, not by the time limit, shape (episodes,).
    """

    observations: Observations
    actions: NDArray[np.float32]
    returns: NDArray[np.float64]
    running: NDArray[np.float64]
    lengths: NDArray[np.int64]
    estimates: NDArray[np.float32]
    flown: NDArray[np.float32]
    rewards: NDArray[np.float64]
    ends: Observations
    terminated: NDArray[np.bool_]

    def told_in(self, episodes: NDArray[np.int64]) -> bool:
        """Whether one of the episodes has an action that is learned from; the teacher's own first ones have."""
        ends = np.cumsum(self.lengths)
        return any(np.isfinite(self.actions[ends[k] - self.lengths[k] : ends[k]]).any() for k in episodes)

    def and_also(self, others: Lessons) -> Lessons:
        """Return these and others, one after the other."""
        return Lessons(
            _both(self.observations, others.observations),
            np.concatenate([self.actions, others.actions]),
            np.concatenate([self.returns, others.returns]),
            np.concatenate([self.running, others.running]),
            np.concatenate([self.lengths, others.lengths]),
            np.concatenate([self.estimates, others.estimates]),
            np.concatenate([self.flown, others.flown]),
            np.concatenate([self.rewards, others.rewards]),
            _both(self.ends, others.ends),
            np.concatenate([self.terminated, others.terminated]),
        )


class Pupil:
    """What a policy without a memory does by now, as an agent."""

    def __init__(self, policy: BasePolicy, envs: VecNormalize) -> None:
        """Take the policy and the environments that normalise what it sees."""
        self._policy, self._envs = policy, envs

    def reset(self, env: gym.Env[Any, Any]) -> None:
        """Do nothing: it remembers nothing."""

    def act(self, observation: Any) -> NDArray[np.float32]:
        """Return its most likely action."""
        action, _ = self._policy.predict(self._envs.normalize_obs(observation), deterministic=True)
        return np.asarray(action, dtype=np.float32)


def taught(
    settings: TrainingSettings,
    imitation: ImitationSettings,
    random: np.random.Generator,
    *,
    pupil: Agent | None = None,
    first: int = TEACHING_SEED,
) -> Lessons:
    """Return what the teacher would have done where it or its pupil flew, disturbed.

    Args:
        settings: of the training.
        imitation: how it begins.
        random: draws what actions are disturbed by.
        pupil: who flies; None lets the teacher fly.
        first: seed of the first episode; the others count up from it.

    Raises:
        InvalidInputError: the teacher cannot fly in this environment.
    """
    env = make_environment(settings.learned_in)
    teacher = make_baseline(imitation.teacher, env, TEACHING_SEED)
    notes = _Notes(settings.algorithm.gamma, space_shape(env.action_space))
    turns = 0 if pupil is None else imitation.turns
    for episode in range(imitation.episodes):
        observation, _ = env.reset(seed=first + episode)
        teacher.reset(env)
        if pupil is not None:
            pupil.reset(env)
        teacher_flies, terminated, truncated = pupil is None, False, False
        while not (terminated or truncated):
            if imitation.forgetful:
                teacher.reset(env)
            wanted = np.clip(teacher.act(observation), -1.0, 1.0)
            # A pupil acts in turns of the teacher, too: what it remembers goes on.
            flown = wanted if pupil is None else pupil.act(observation)
            if turns and random.random() < 1.0 / turns:
                teacher_flies = not teacher_flies
            counts = teacher_flies or not turns
            notes.take(observation, wanted if counts else None, estimate_of(teacher))
            disturbed = with_noise(wanted if teacher_flies else flown, imitation.noise, random)
            observation, reward, terminated, truncated, _ = env.step(disturbed)
            notes.outcome(disturbed, float(reward))
        notes.end_episode(observation, whole=terminated)
    env.close()
    return notes.lessons()


class _Notes:
    """What is taken down of flights, period by period."""

    def __init__(self, gamma: float, axes: tuple[int, ...]) -> None:
        """Take the discount and the shape of actions."""
        self._gamma, self._unknown = gamma, np.full(axes, np.nan, np.float32)
        self._observations: list[Any] = []
        self._actions: list[Any] = []
        self._estimates: list[NDArray[np.float64]] = []
        self._flown: list[Any] = []
        self._rewards: list[list[float]] = [[]]
        self._returns: list[NDArray[np.float64]] = []
        self._running: list[NDArray[np.float64]] = []
        self._ends: list[Any] = []
        self._whole: list[bool] = []

    def take(self, observation: Any, wanted: Any | None, estimate: NDArray[np.float64]) -> None:
        """Take down the beginning of a period; None is an action that is not learned from."""
        self._observations.append(observation)
        self._actions.append(self._unknown if wanted is None else wanted)
        self._estimates.append(estimate)

    def outcome(self, flown: Any, reward: float) -> None:
        """Take down what was done in the period, and what that earned."""
        self._flown.append(flown)
        self._rewards[-1].append(reward)

    def end_episode(self, observation: Any, *, whole: bool) -> None:
        """Take down with what an episode has ended, by itself or by the time limit."""
        self._returns.append(_returns(self._rewards[-1], self._gamma, whole=whole))
        self._running.append(_discounted(self._rewards[-1], self._gamma))
        self._ends.append(observation)
        self._whole.append(whole)
        self._rewards.append([])

    def lessons(self) -> Lessons:
        """Return all of it."""
        return Lessons(
            _stacked(self._observations),
            np.array(self._actions, dtype=np.float32),
            np.concatenate(self._returns),
            np.concatenate(self._running),
            np.array([len(rewards) for rewards in self._running], dtype=np.int64),
            np.array(self._estimates, dtype=np.float32).reshape(len(self._actions), -1),
            np.array(self._flown, dtype=np.float32),
            np.concatenate(self._rewards),
            _stacked(self._ends),
            np.array(self._whole),
        )


def _discounted(rewards: list[float], gamma: float) -> NDArray[np.float64]:
    """Return the running sum of rewards, of which a share gamma is kept from one to the next."""
    total, sums = 0.0, []
    for reward in rewards:
        total = gamma * total + reward
        sums.append(total)
    return np.array(sums)


def _returns(rewards: list[float], gamma: float, *, whole: bool) -> NDArray[np.float64]:
    """Return the discounted returns from each period on; NaN near the end of an episode that was cut off."""
    returns = _discounted(rewards[::-1], gamma)[::-1].copy()
    if not whole:
        unknown = len(rewards) if gamma == 1.0 else round(FORESIGHT / (1.0 - gamma))
        returns[max(0, len(rewards) - unknown) :] = np.nan
    return returns


def _stacked(observations: list[Any]) -> Observations:
    if isinstance(observations[0], Mapping):
        return {name: np.array([one[name] for one in observations]) for name in observations[0]}
    return np.array(observations)


def _both(these: Any, those: Any) -> Observations:
    if isinstance(these, dict):
        return {name: np.concatenate([values, those[name]]) for name, values in these.items()}
    return np.concatenate([these, those])
