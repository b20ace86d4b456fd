"""One trial on a machine that has no study: it asks whether to go on, and says what it came to."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.errors import InvalidInputError
from dq_marine.util.cluster_desk import Desk


class _GivenUpError(Exception):
    """The answer was to give up."""


def try_elsewhere(
    folder: Path, plan: StudyPlan, settings: TrainingSettings, number: int, desk: Desk
) -> float | None:
    """Train one trial, and return the best mean return of its evaluations, or None if it was given up.

    Args:
        folder: of the study, absolute; logs go into it where this machine sees it, else nowhere.
        plan: of the study.
        settings: of the trial.
        number: of the trial.
        desk: where to ask, after each evaluation, whether to give up.

    Raises:
        MissingDependencyError: a library that learns is not installed.
        ValueError: the learner met numbers that are not finite.
    """
    from dq_marine.agents.tuning.trial import trial_return  # here: it imports torch

    def tell(timesteps: int, mean_return: float) -> None:
        if desk.ask(number, (timesteps, mean_return)):
            raise _GivenUpError

    with _logs(StudyFolder(folder), plan) as logs:
        try:
            return trial_return(settings, seed=plan.seed, logs=logs / f"trial{number:04d}", tell=tell)
        except _GivenUpError:
            return None


@contextlib.contextmanager
def _logs(folder: StudyFolder, plan: StudyPlan) -> Iterator[Path]:
    """Yield a folder for TensorBoard: the study's, or one that is removed after the block."""
    try:
        seen = folder.read_plan() == plan
    except InvalidInputError:
        seen = False
    if seen:
        yield folder.tensorboard
        return
    with tempfile.TemporaryDirectory(prefix="dq-marine-trial-", ignore_cleanup_errors=True) as scratch:
        yield Path(scratch)
