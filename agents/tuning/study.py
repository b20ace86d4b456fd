"""The study on disk: Optuna's, made if need be, gone on with, and read as trials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dq_marine.agents.training.run_folder import LARGEST_SEED
from dq_marine.agents.tuning.search_space import Space, chosen_values, proposals_of, search_space
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed

with extra_needed("a search for hyperparameters", "tune"):
    import optuna
    from optuna.trial import FrozenTrial, TrialState

UNJUDGED_TRIALS = 4
"""Before any is given up."""

UNJUDGED_SHARE = 0.25
"""Of a trial's timesteps, before it may be given up."""

AGAIN = "again"
"""Attribute of a trial that tries again what a killed process left behind: the number of that trial."""

FAILURES = (InvalidInputError, ValueError, ArithmeticError)
"""Of one trial, after which the search goes on: values that do not go together, and numbers that are not finite."""


@dataclass(frozen=True)
class Tried:
    """A trial that ended.

    Attributes:
        number: it counts up from 0, which is the training as it is.
        mean_return: of its best evaluation; None if it failed.
        timesteps: after which it ended.
        given_up: whether it ended early.
        values: that it trained with, by the paths of their fields in the settings.
    """

    number: int
    mean_return: float | None
    timesteps: int
    given_up: bool
    values: dict[str, Any]


def tried(study: optuna.Study, plan: StudyPlan) -> list[Tried]:
    """Return the trials that ended, the best first, failed ones last."""
    space = search_space(plan.base)
    return sorted(
        (_tried(trial, space) for trial in ended(study)),
        key=lambda one: (one.mean_return is None, one.given_up, -(one.mean_return or 0.0), one.number),
    )


def _tried(trial: FrozenTrial, space: Space) -> Tried:
    told = trial.intermediate_values
    return Tried(
        number=trial.number,
        mean_return=None if trial.state is TrialState.FAIL else trial.value,
        timesteps=max(told, default=0),
        given_up=trial.state is TrialState.PRUNED,
        values=chosen_values(space, optuna.trial.FixedTrial(trial.params, trial.number)),
    )


def study_on_disk(folder: StudyFolder, plan: StudyPlan, index: int = 0) -> optuna.Study:
    """Return the study on disk, made if need be, with the sampler of its trial of that index."""
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    warmup = int(UNJUDGED_SHARE * plan.base.timesteps)
    return optuna.create_study(
        study_name="study",
        storage=f"sqlite:///{folder.database.resolve()}",
        load_if_exists=True,
        direction="maximize",
        sampler=sampler_of(plan, index),
        pruner=optuna.pruners.MedianPruner(n_startup_trials=UNJUDGED_TRIALS, n_warmup_steps=warmup),
    )


def sampler_of(plan: StudyPlan, index: int) -> optuna.samplers.BaseSampler:
    """Return a sampler of a trial's own, so that a search that was stopped goes on as if it had not been."""
    return optuna.samplers.TPESampler(seed=(plan.seed + index) % (LARGEST_SEED + 1))


def take_up(study: optuna.Study, plan: StudyPlan) -> None:
    """Have the training as it is tried first, and again what a killed process left behind."""
    if not study.trials:
        study.enqueue_trial(proposals_of(plan.base, search_space(plan.base)))
    for trial in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
        study.enqueue_trial(trial.params, user_attrs={AGAIN: trial.number})
        study.tell(trial.number, state=TrialState.FAIL)


def ended(study: optuna.Study) -> list[FrozenTrial]:
    """Return the trials that ended, without those that are tried again."""
    trials = study.get_trials(deepcopy=False)
    again = {trial.user_attrs.get(AGAIN) for trial in trials}
    return [trial for trial in trials if trial.state.is_finished() and trial.number not in again]


def asked(study: optuna.Study) -> int:
    """Return the number of another trial to be trained.

    Only the process that hands trials out asks for them: two that ask at once may be given the same one that waits.
    """
    return study.ask().number
