"""A policy that begins as the copy of a baseline, and a critic that knows what that earns, before they learn.

Behaviour cloning (Pomerleau 1991, Neural Computation 3(1)): the policy's mean is fitted to what the teacher would do.
The teacher's actions are disturbed while it flies, so that the pupil sees how one comes back from where the teacher by
itself would never be (Laskey et al. 2017, DART, CoRL). Where the pupil still goes astray, it flies itself in further
rounds, and learns what the teacher would have done there (Ross et al. 2011, DAgger, AISTATS). A critic that knew
nothing would lead the first updates away from what was copied, so it is fitted to the discounted returns.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.baselines import Agent, make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.noise import with_noise
from dq_marine.agents.settings import ImitationSettings, TrainingSettings
from dq_marine.agents.training.algorithms import Model
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.policies import ActorCriticPolicy
    from stable_baselines3.common.vec_env import VecNormalize

TEACHING_SEED = 3_000_000
"""Of the teacher's first episode: far from the seeds that training counts up from, and from those of evaluations."""

HELD_BACK = 0.1
"""Share of what was flown that is not learned from, but tells how well the rest was."""

SETTLED = 1e15
"""Number of observations that statistics are said to be of, so that those to come do not change them."""

FORESIGHT = 3.0
"""Of the discounted return of an episode that the time limit cuts off, that from so many times 1/(1 - gamma) before the
end is whole but for exp(-3) of it: later ones teach the critic nothing."""

Observations = NDArray[np.float32] | dict[str, NDArray[np.float32]]


@dataclass(frozen=True)
class Lessons:
    """What a teacher flew: n control periods.

    Attributes:
        observations: at their beginnings, shape (n, observed), or that for each part of an observation with goals.
        actions: what the teacher would have done, shape (n, axes).
        returns: discounted, from each on, shape (n,); NaN where too little of it was flown.
        running: what `VecNormalize` sums up of rewards, by which it divides them, shape (n,).
    """

    observations: Observations
    actions: NDArray[np.float32]
    returns: NDArray[np.float64]
    running: NDArray[np.float64]

    def and_also(self, others: Lessons) -> Lessons:
        """Return these and others, one after the other."""
        return Lessons(
            _both(self.observations, others.observations),
            np.concatenate([self.actions, others.actions]),
            np.concatenate([self.returns, others.returns]),
            np.concatenate([self.running, others.running]),
        )


def imitate(model: Model, settings: TrainingSettings, seed: int) -> float:
    """Let a model that has learned nothing begin as the copy of a baseline.

    Args:
        model: of PPO, in its normalised environments, whose statistics become those of what was flown.
        settings: of the training, with `imitation`.
        seed: of the training: what is disturbed and in which order it is learned follow from it.

    Returns:
        The mean square difference of the actions, over episodes and axes, of what it did not learn from.

    Raises:
        InvalidInputError: the teacher cannot fly in this environment, or the algorithm cannot imitate.
    """
    policy, envs, imitation = model.policy, model.get_vec_normalize_env(), settings.imitation
    if not isinstance(policy, ActorCriticPolicy) or envs is None or imitation is None:
        raise InvalidInputError(f"{settings.algorithm.name} cannot begin as a copy; train with ppo")
    flying = np.random.default_rng([seed, TEACHING_SEED])
    learning = np.random.default_rng([seed, TEACHING_SEED + 1])
    lessons = taught(settings, imitation, flying)
    _take_statistics(envs, lessons)
    difference = _learn(policy, envs, lessons, imitation, learning)
    for number in range(1, imitation.rounds + 1):
        first = TEACHING_SEED + number * imitation.episodes
        further = taught(settings, imitation, flying, pupil=Pupil(policy, envs), first=first)
        _take_statistics(envs, further)
        lessons = lessons.and_also(further)
        difference = _learn(policy, envs, lessons, imitation, learning)
    if imitation.rounds:
        _settle_statistics(envs)
    return difference


def _learn(
    policy: ActorCriticPolicy,
    envs: VecNormalize,
    lessons: Lessons,
    imitation: ImitationSettings,
    random: np.random.Generator,
) -> float:
    """Fit the policy to the actions and the critic to the returns; return how far actions held back are missed."""
    observations, _ = policy.obs_to_tensor(envs.normalize_obs(lessons.observations))
    actions = torch.as_tensor(lessons.actions)
    scale = np.sqrt(envs.ret_rms.var + envs.epsilon) if envs.norm_reward else 1.0
    returns = torch.as_tensor(np.asarray(lessons.returns / scale, dtype=np.float32))
    held_back, learned = np.split(random.permutation(len(actions)), [max(1, round(HELD_BACK * len(actions)))])
    optimiser = torch.optim.Adam(policy.parameters(), lr=imitation.learning_rate)
    policy.set_training_mode(True)
    for batch in _batches(learned, imitation, random):
        mean, values = _foretold(policy, _rows_of(observations, batch))
        known = torch.isfinite(returns[batch])
        loss = torch.nn.functional.mse_loss(mean, actions[batch])
        if known.any():
            loss = loss + torch.nn.functional.mse_loss(values[known], returns[batch][known])
        optimiser.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        optimiser.step()
    policy.set_training_mode(False)
    with torch.no_grad():
        mean, _ = _foretold(policy, _rows_of(observations, held_back))
        return float(torch.nn.functional.mse_loss(mean, actions[held_back]))


class Pupil:
    """What the policy does by now, as an agent."""

    def __init__(self, policy: ActorCriticPolicy, envs: VecNormalize) -> None:
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
    gamma = settings.algorithm.gamma
    observations: list[Any] = []
    actions: list[Any] = []
    returns: list[NDArray[np.float64]] = []
    running: list[NDArray[np.float64]] = []
    for episode in range(imitation.episodes):
        observation, _ = env.reset(seed=first + episode)
        teacher.reset(env)
        rewards, terminated, truncated = [], False, False
        while not (terminated or truncated):
            action = np.clip(teacher.act(observation), -1.0, 1.0)
            observations.append(observation)
            actions.append(action)
            flown = action if pupil is None else pupil.act(observation)
            disturbed = with_noise(flown, imitation.noise, random)
            observation, reward, terminated, truncated, _ = env.step(disturbed)
            rewards.append(float(reward))
        returns.append(_returns(rewards, gamma, whole=terminated))
        running.append(_discounted(rewards, gamma))
    env.close()
    return Lessons(
        _stacked(observations),
        np.array(actions, dtype=np.float32),
        np.concatenate(returns),
        np.concatenate(running),
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


def _take_statistics(envs: VecNormalize, lessons: Lessons) -> None:
    """Let the environments normalise by what was flown until they know better."""
    if envs.norm_obs:
        parts = lessons.observations if isinstance(lessons.observations, dict) else {"": lessons.observations}
        kept = envs.obs_rms if isinstance(envs.obs_rms, dict) else {"": envs.obs_rms}
        for name, values in parts.items():
            kept[name].update(values)
    if envs.norm_reward:
        envs.ret_rms.update(lessons.running)


def _settle_statistics(envs: VecNormalize) -> None:
    """Let observations be normalised as they are now from here on.

    Further rounds are flown where the pupil went astray, unlike what is to come: means and deviations would drift, and
    what a policy does with the numbers that it has learned to read would drift with them.
    """
    if envs.norm_obs:
        for running in envs.obs_rms.values() if isinstance(envs.obs_rms, dict) else [envs.obs_rms]:
            running.count = SETTLED


def _batches(
    rows: NDArray[np.int64], imitation: ImitationSettings, random: np.random.Generator
) -> Iterator[NDArray[np.int64]]:
    """Yield the rows in batches, in another order in each epoch."""
    for _ in range(imitation.epochs):
        order = random.permutation(rows)
        for start in range(0, len(order), imitation.batch_size):
            yield order[start : start + imitation.batch_size]


def _rows_of(observations: Any, rows: NDArray[np.int64]) -> Any:
    if isinstance(observations, dict):
        return {name: values[rows] for name, values in observations.items()}
    return observations[rows]


def _foretold(policy: ActorCriticPolicy, observations: Any) -> tuple[torch.Tensor, torch.Tensor]:
    """Return the mean of the actions, shape (n, axes), and the critic's values, shape (n,)."""
    distribution: Any = policy.get_distribution(observations).distribution  # torch's normal one, not SB3's
    return distribution.mean, policy.predict_values(observations).flatten()
