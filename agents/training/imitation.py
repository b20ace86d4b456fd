"""A policy that begins as the copy of a baseline, and a critic that knows what that earns, before they learn.

Behaviour cloning (Pomerleau 1991, Neural Computation 3(1)): the policy's mean is fitted to what the teacher would do.
The teacher's actions are disturbed while it flies, so that the pupil sees how one comes back from where the teacher by
itself would never be (Laskey et al. 2017, DART, CoRL). Where the pupil still goes astray, it flies itself in further
rounds, and learns what the teacher would have done there (Ross et al. 2011, DAgger, AISTATS). A critic that knew
nothing would lead the first updates away from what was copied, so it is fitted to the discounted returns.

An algorithm that learns from a memory remembers what was flown, and keeps to its copy while it learns (`keeping`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from dq_marine.agents.controllers.baselines import Agent
from dq_marine.agents.settings import ImitationSettings, TrainingSettings
from dq_marine.agents.training.algorithms import Model
from dq_marine.agents.training.fitting import fit_steps
from dq_marine.agents.training.fitting_replay import fit_actor, fit_critics
from dq_marine.agents.training.keeping import keep_copy
from dq_marine.agents.training.recurrent_decision import RememberingPupil
from dq_marine.agents.training.remembering import remember
from dq_marine.agents.training.teaching import TEACHING_SEED, Lessons, Pupil, taught
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
    from stable_baselines3.common.policies import ActorCriticPolicy, BasePolicy
    from stable_baselines3.common.vec_env import VecNormalize

KEEPING = 4.0
"""How much a copy counts where settings say nothing. Fujimoto and Gu 2021 (arXiv:2106.06860) have 0.4, which loses the
copy where values are near 0, as in WaypointTracking."""

SETTLED = 1e15
"""Number of observations that statistics are said to be of, so that those to come do not change them."""

Fit: TypeAlias = Callable[
    [Any, VecNormalize, Lessons, ImitationSettings, np.random.Generator],
    float,
]

MakePupil: TypeAlias = Callable[[Any, VecNormalize], Agent]


def imitate(
    model: Model, settings: TrainingSettings, seed: int, *, say: Callable[[str], None] = lambda words: None
) -> float:
    """Let a model that has learned nothing begin as the copy of a baseline.

    Args:
        model: in its normalised environments, whose statistics become those of what was flown. One that learns from a
            memory remembers what was flown, too.
        settings: of the training, with `imitation`.
        seed: of the training: what is disturbed and in which order it is learned follow from it.
        say: is told what is being done.

    Returns:
        The mean square difference of the actions, over episodes and axes, of what it did not learn from.

    Raises:
        InvalidInputError: the teacher cannot fly in this environment, or there are no settings of imitation.
    """
    policy, envs, imitation = model.policy, model.get_vec_normalize_env(), settings.imitation
    if envs is None or imitation is None:
        raise InvalidInputError("there is nothing to imitate by; give settings with imitation")
    fit, make_pupil = _learner_of(policy)
    flying = np.random.default_rng([seed, TEACHING_SEED])
    learning = np.random.default_rng([seed, TEACHING_SEED + 1])
    say(f"the {imitation.teacher} flies {imitation.episodes} episodes")
    lessons = taught(settings, imitation, flying)
    _take_statistics(envs, lessons)
    say("what it flew is learned")
    difference = fit(policy, envs, lessons, imitation, learning)
    for number in range(1, imitation.rounds + 1):
        which = f"round {number} of {imitation.rounds}"
        say(f"{which}: the policy flies {imitation.episodes} episodes")
        first = TEACHING_SEED + number * imitation.episodes
        further = taught(settings, imitation, flying, pupil=make_pupil(policy, envs), first=first)
        _take_statistics(envs, further)
        lessons = lessons.and_also(further)
        say(f"{which}: what the {imitation.teacher} would have done is learned")
        difference = fit(policy, envs, lessons, imitation, learning)
    if imitation.rounds or isinstance(model, OffPolicyAlgorithm):
        _settle_statistics(envs)
    if isinstance(model, OffPolicyAlgorithm):
        say("what that earns is learned")
        fit_critics(model, envs, lessons, imitation, learning)
        remember(model, lessons)
        keep_copy(model, KEEPING if imitation.keeping is None else imitation.keeping)
    return difference


def _learner_of(policy: BasePolicy) -> tuple[Fit, MakePupil]:
    """Return what fits a policy, and what lets it fly."""
    if hasattr(policy, "lstm_actor"):
        from dq_marine.agents.training.fitting_memory import fit_episodes  # here: it imports sb3-contrib

        return fit_episodes, RememberingPupil
    return fit_steps if isinstance(policy, ActorCriticPolicy) else fit_actor, Pupil


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
    what a policy does with the numbers that it has learned to read would drift with them, and so would a copy that is
    kept.
    """
    if envs.norm_obs:
        for running in envs.obs_rms.values() if isinstance(envs.obs_rms, dict) else [envs.obs_rms]:
            running.count = SETTLED
