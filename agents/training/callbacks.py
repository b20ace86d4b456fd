"""What happens while Stable-Baselines3 learns: checkpoints, evaluations, and telling how it goes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from rich.progress import Progress as ProgressBar
from rich.progress import TaskID

from dq_marine.agents.training.algorithms import Model
from dq_marine.agents.training.episode_log import episode_tags, mean_tags, metrics_in
from dq_marine.agents.training.learners import save_model
from dq_marine.agents.training.run_folder import Kind, RunFolder
from dq_marine.agents.training.snapshots import Progress
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.callbacks import BaseCallback, EvalCallback
    from stable_baselines3.common.vec_env import VecEnv


def check_callbacks(callbacks: Sequence[BaseCallback]) -> None:
    """Check what a caller gave, before anything is written.

    Raises:
        InvalidInputError: it is no sequence of callbacks.
    """
    if not isinstance(callbacks, Sequence) or not all(isinstance(one, BaseCallback) for one in callbacks):
        raise InvalidInputError(
            f"callbacks = {shown(callbacks)}; give a list of callbacks of Stable-Baselines3's, made already, such as "
            "[WandbCallback()]"
        )


class Saves(Protocol):
    """Takes models to save."""

    def save(self, kind: Kind, model: Model, mean_return: float | None = None) -> None:
        """Save a snapshot, or do not."""


class Saver:
    """Saves snapshots of a model into a run's folder, with the time spent so far.

    Attributes:
        lesson: of the curriculum that the model learns, from 0 on.
    """

    def __init__(self, folder: RunFolder) -> None:
        """Start the session's clock."""
        self._folder = folder
        before = folder.progress("checkpoints")
        self.lesson, self._spent_before = before.lesson, before.wall_time
        self._began = time.monotonic()

    @property
    def wall_time(self) -> float:
        """Time spent on the run [s], over all sessions."""
        return self._spent_before + time.monotonic() - self._began

    def save(self, kind: Kind, model: Model, mean_return: float | None = None) -> None:
        """Save a snapshot; the replay buffer goes with checkpoints, which training is resumed from."""

        def write(folder: Path) -> None:
            save_model(model, folder, replay_buffer=kind == "checkpoints")

        progress = Progress(model.num_timesteps, self.wall_time, mean_return, self.lesson)
        self._folder.save(kind, progress, write)


class Checkpoints(BaseCallback):
    """Saves a checkpoint every so many timesteps, between two updates, where nothing collected is lost."""

    def __init__(self, saver: Saver, every: int) -> None:
        """Take the number of timesteps between checkpoints."""
        super().__init__()
        self._saver = saver
        self._every = every
        self._saved_at = 0

    def _on_training_start(self) -> None:
        self._saved_at = self.num_timesteps

    def _on_rollout_start(self) -> None:
        if self.num_timesteps - self._saved_at >= self._every:
            self._saved_at = self.num_timesteps
            self._saver.save("checkpoints", self.model)

    def _on_step(self) -> bool:
        return True


class Evaluations(EvalCallback):
    """Evaluates every so many timesteps and saves the best model; normalisation follows the training's.

    Every evaluation has the same starts and currents, so that the best is not the luckiest.
    """

    def __init__(
        self,
        envs: VecEnv,
        saver: Saves,
        *,
        every: int,
        training_envs: int,
        seed: int,
        best: float | None,
        at_first: bool = False,
    ) -> None:
        """Take environments, one for each episode.

        Args:
            envs: to evaluate in.
            saver: of the best model.
            every: timesteps between evaluations.
            training_envs: how many timesteps one step of the training environments counts.
            seed: of the first environment; they count up from it.
            best: mean return to beat, None if there is none yet.
            at_first: whether what has not begun to learn is evaluated, too: a copy may be better than what it becomes.
        """
        super().__init__(
            envs,
            callback_on_new_best=_SaveBest(saver),
            n_eval_episodes=envs.num_envs,
            eval_freq=max(every // training_envs, 1),
            verbose=0,
        )
        self._seed = seed
        self._at_first = at_first
        self._metrics = metrics_in(envs)
        self._flown: list[dict[str, float]] = []
        if best is not None:
            self.best_mean_reward = best

    def _on_training_start(self) -> None:
        if self._at_first and self.num_timesteps == 0:
            self._on_step()  # the first evaluation is due after no steps

    def _on_step(self) -> bool:
        self.eval_env.seed(self._seed)  # takes effect at the next reset, which begins an evaluation
        self._flown = []
        return bool(super()._on_step())

    def _log_success_callback(self, locals_: dict[str, Any], globals_: dict[str, Any]) -> None:
        """Take down each episode's end; the means over those so far stand when the evaluation is logged."""
        super()._log_success_callback(locals_, globals_)
        if locals_["done"]:
            self._flown.append(episode_tags(locals_["info"], self._metrics))
            for tag, mean in mean_tags(self._flown).items():
                self.logger.record(f"eval/{tag}", mean)


class _SaveBest(BaseCallback):
    """Saves the model; called by an evaluation that was the best so far."""

    parent: Evaluations

    def __init__(self, saver: Saves) -> None:
        super().__init__()
        self._saver = saver

    def _on_step(self) -> bool:
        self._saver.save("best", self.model, mean_return=self.parent.best_mean_reward)
        return True


class ProgressUpdates(BaseCallback):
    """Moves a progress bar and says the returns of late and of the best evaluation."""

    def __init__(self, bar: ProgressBar, task: TaskID, evaluations: Evaluations) -> None:
        """Take the bar and its task, whose total is the run's timesteps."""
        super().__init__()
        self._bar = bar
        self._task = task
        self._evaluations = evaluations

    def _on_step(self) -> bool:
        self._bar.update(self._task, completed=self.num_timesteps)
        return True

    def _on_rollout_end(self) -> None:
        late = self.model.ep_info_buffer
        mean = f"{np.mean([episode['r'] for episode in late]):.1f}" if late else "-"
        best = self._evaluations.best_mean_reward
        self._bar.update(self._task, late=mean, best=f"{best:.1f}" if np.isfinite(best) else "-")
