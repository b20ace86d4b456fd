"""Stable-Baselines3 models and vector environments, from settings.

SB3's zip and pickle files run code when they are loaded: load only runs that you trust.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium as gym

from dq_marine.agents.environments import make_environments
from dq_marine.agents.settings import EnvironmentSettings, TrainingSettings
from dq_marine.agents.training.algorithms import (
    LinearSchedule,  # noqa: F401 - models of earlier runs hold it by its name here
    Model,
    keywords_of,
    model_class,
    policy_name,
    privileged_policy,
)
from dq_marine.agents.training.keeping import go_on_keeping
from dq_marine.agents.training.reward_sums import RewardSums
from dq_marine.agents.training.run_folder import MODEL_FILE, NORMALISATION_FILE, REPLAY_BUFFER_FILE
from dq_marine.agents.training.symlog import SymlogNormalize
from dq_marine.agents.training.vec_env import MarineVecEnv
from dq_marine.checks import shown
from dq_marine.envs.vector.vector_env import MarineVectorEnv
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
    from stable_baselines3.common.vec_env import VecEnv, VecMonitor, VecNormalize

DEVICE = "cpu"
"""Networks this small wait longer for an accelerator than they compute."""


def make_training_envs(settings: TrainingSettings) -> VecNormalize:
    """Return the environments to learn in, normalised with running statistics; a model seeds env i with seed + i."""
    normalisation = settings.normalisation
    return _normalised_by(settings)(
        _environments(settings.learned_in, settings.envs),
        norm_obs=normalisation.observation,
        norm_reward=normalisation.reward,
        clip_obs=normalisation.clip,
        clip_reward=normalisation.clip,
        gamma=settings.algorithm.gamma,
    )


def make_evaluation_envs(settings: TrainingSettings) -> VecNormalize:
    """Return environments to evaluate in, one for each episode; their normalisation follows the training's."""
    return _normalised_by(settings)(
        _environments(settings.evaluated_in, settings.evaluation.episodes),
        training=False,
        norm_obs=settings.normalisation.observation,
        norm_reward=False,
        clip_obs=settings.normalisation.clip,
    )


def _normalised_by(settings: TrainingSettings) -> type[VecNormalize]:
    return SymlogNormalize if settings.normalisation.symlog else VecNormalize


def make_model(settings: TrainingSettings, seed: int, tensorboard: Path) -> Model:
    """Return an untrained model with its environments; it logs into the folder `tensorboard`.

    Raises:
        InvalidInputError: the algorithm does not take the observations.
        MissingDependencyError: the library of the algorithm is not installed.
    """
    envs = make_training_envs(settings)
    return model_class(settings.algorithm.name)(
        _policy(settings, envs.observation_space),
        envs,
        **keywords_of(settings, _marine(envs).single),
        seed=seed,
        tensorboard_log=str(tensorboard),
        device=DEVICE,
    )


def _policy(settings: TrainingSettings, space: gym.Space[Any]) -> str | type[Any]:
    """Return the policy to learn from observations of a space: a class, or what the library calls it."""
    if settings.privileged_critic:
        return privileged_policy(settings.algorithm)
    return policy_name(settings.algorithm, goals=isinstance(space, gym.spaces.Dict))


def environments_of(model: Model) -> MarineVectorEnv:
    """Return the environments that a model learns in, inside their wrappers."""
    return _marine(model.get_env())


def _marine(envs: VecEnv | None) -> MarineVectorEnv:
    inner = envs.unwrapped if envs is not None else None
    if not isinstance(inner, MarineVecEnv):
        raise InvalidInputError(f"the model learns in {inner}, not in environments of dq_marine")
    return inner.marine


def save_model(model: Model, folder: Path, *, replay_buffer: bool) -> None:
    """Write model, normalisation and, where asked for and there is one, replay buffer into a folder."""
    with (folder / MODEL_FILE).open("wb") as file:  # SB3 would leave a file of its own open on a full disk
        model.save(file)
    normalisation = model.get_vec_normalize_env()
    if normalisation is not None:
        normalisation.save(str(folder / NORMALISATION_FILE))
    if replay_buffer and isinstance(model, OffPolicyAlgorithm):
        with (folder / REPLAY_BUFFER_FILE).open("wb") as file:
            model.save_replay_buffer(file)


def load_model(settings: TrainingSettings, folder: Path, seed: int, tensorboard: Path) -> Model:
    """Return the model that `save_model` wrote with its replay buffer, ready to go on learning.

    Episodes begin anew, from another seed than the run began with, or the same starts would be learned twice.

    Raises:
        InvalidInputError: a file is missing, or cannot be read as what it should be.
    """
    venv = make_training_envs(settings).venv
    with refusing_damage(folder):
        envs = VecNormalize.load(str(folder / NORMALISATION_FILE), venv)
        model = model_class(settings.algorithm.name).load(
            folder / MODEL_FILE, env=envs, device=DEVICE, tensorboard_log=str(tensorboard)
        )
        model.set_random_seed(seed)
        if isinstance(model, OffPolicyAlgorithm):
            model.load_replay_buffer(folder / REPLAY_BUFFER_FILE)
            go_on_keeping(model)
    return model


@contextmanager
def refusing_damage(folder: Path) -> Iterator[None]:
    """Say which snapshot it is, and what helps, where one cannot be loaded within the block.

    Raises:
        InvalidInputError: the block failed; what reads a pickle of another version may do so with anything.
    """
    try:
        yield
    except Exception as error:
        raise InvalidInputError(
            f"{folder} cannot be loaded: {shown(error)}; it is damaged, or of other settings or versions than "
            "run.json has: restore it from a copy, install those versions, or train anew with --force"
        ) from error


def _environments(settings: EnvironmentSettings, count: int) -> VecMonitor:
    """Return environments that are stepped together and report their episodes."""
    return VecMonitor(MarineVecEnv(RewardSums(make_environments(settings, count))))
