"""One trial of a search: a training that tells how it goes and keeps nothing but its logs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.algorithms import Model
from dq_marine.agents.training.callbacks import Evaluations
from dq_marine.agents.training.imitation import imitate
from dq_marine.agents.training.learners import environments_of, make_evaluation_envs, make_model
from dq_marine.agents.training.run_folder import Kind
from dq_marine.agents.training.training import EVALUATION_SEED
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.callbacks import BaseCallback


class _KeepsNothing:
    """Takes models to save, as `callbacks.Saver` does, and saves none."""

    def save(self, kind: Kind, model: Model, mean_return: float | None = None) -> None:
        """Do nothing."""


class _Tells(BaseCallback):
    """Tells the best mean return so far after each evaluation; what it tells may end the training by an exception."""

    def __init__(self, evaluations: Evaluations, tell: Callable[[int, float], None]) -> None:
        super().__init__()
        self._evaluations = evaluations
        self._tell = tell

    def _on_step(self) -> bool:
        if self.n_calls % self._evaluations.eval_freq == 0:
            self._tell(self.num_timesteps, float(self._evaluations.best_mean_reward))
        return True


def trial_return(
    settings: TrainingSettings, *, seed: int, logs: Path, tell: Callable[[int, float], None]
) -> float:
    """Train, and return the best mean return of the evaluations on the way.

    Args:
        settings: of the training; `evaluation.every` says how often it is told how it goes.
        seed: of networks, starts and currents.
        logs: folder for TensorBoard.
        tell: called with the timesteps so far and the best mean return so far; what it raises ends the training.

    Raises:
        ValueError: the learner met numbers that are not finite.
    """
    torch.set_num_threads(settings.torch_threads)
    model = make_model(settings, seed, logs)
    if settings.imitation is not None:
        imitate(model, settings, seed)
    evaluations = Evaluations(
        make_evaluation_envs(settings),
        _KeepsNothing(),
        every=settings.evaluation.every,
        training_envs=settings.envs,
        seed=EVALUATION_SEED,
        best=None,
    )
    try:
        model.learn(settings.timesteps, callback=[evaluations, _Tells(evaluations, tell)])
    finally:
        environments_of(model).close()
        evaluations.eval_env.close()
    return float(evaluations.best_mean_reward)
