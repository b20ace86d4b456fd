"""Learning at one level of difficulty after the other, the last of which is the environment's own.

A lesson ends when enough of the last episodes succeeded (Narvekar et al. 2020, Journal of Machine Learning Research
21(181), 4.2). The model goes on as it is, and so do the statistics that observations and rewards are normalised by.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from dq_marine.agents.evaluation.metrics import SUCCESS
from dq_marine.agents.settings import CurriculumSettings, TrainingSettings
from dq_marine.agents.training.algorithms import Model
from dq_marine.agents.training.learners import make_training_envs
from dq_marine.agents.training.lessons import lessons_of
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.vec_env import sync_envs_normalization


def learn_lesson(
    model: Model, settings: TrainingSettings, number: int, callbacks: Sequence[BaseCallback]
) -> bool:
    """Let a model learn one lesson until it can do it, or until the run has its timesteps.

    Args:
        model: in the environments of the lesson; in those of the next one, once it has passed.
        settings: of the run.
        number: of the lesson, from 0 on.
        callbacks: of the learning.

    Returns:
        Whether it has passed; the last lesson ends with the timesteps alone.
    """
    lessons = lessons_of(settings)
    graduations = (
        [Graduation(settings.curriculum, number)] if settings.curriculum and lessons[number + 1 :] else []
    )
    left = settings.timesteps - model.num_timesteps
    model.learn(left, callback=[*callbacks, *graduations], reset_num_timesteps=False)
    if not any(one.passed for one in graduations):
        return False
    _go_on_to(model, lessons[number + 1])
    return True


class Graduation(BaseCallback):
    """Ends a lesson once enough of its last episodes succeeded; logs which it is.

    Attributes:
        passed: whether it has.
    """

    def __init__(self, curriculum: CurriculumSettings, number: int) -> None:
        """Take what is enough, and the number of the lesson, for the log."""
        super().__init__()
        self.passed = False
        self._enough, self._number = curriculum.success, number
        self._late: deque[bool] = deque(maxlen=curriculum.episodes)

    def _on_step(self) -> bool:
        infos = self.locals["infos"]
        self._late.extend(bool(infos[one][SUCCESS]) for one in np.flatnonzero(self.locals["dones"]).tolist())
        self.logger.record("curriculum/lesson", self._number)
        full = len(self._late) == self._late.maxlen
        self.passed = full and float(np.mean(self._late)) >= self._enough
        return not self.passed


def _go_on_to(model: Model, lesson: TrainingSettings) -> None:
    """Let a model learn in the environments of another lesson from now on."""
    envs, before = make_training_envs(lesson), model.get_env()
    if before is not None:
        sync_envs_normalization(before, envs)
        before.close()
    model.set_env(envs)
