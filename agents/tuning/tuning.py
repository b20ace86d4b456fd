"""Search for hyperparameters by Optuna, in one process or several, which goes on where it was stopped.

The first trial is the training as it is, so that the best is no worse. Others are proposed by a tree-structured Parzen
estimator (Bergstra et al. 2011, NeurIPS), and given up where they are worse than the median of those before (Golovin et
al. 2017, KDD). The return counts that the run would keep: of its best evaluation.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from itertools import islice
from typing import Any

from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.beginning import check_can_begin
from dq_marine.agents.training.run_folder import LARGEST_SEED
from dq_marine.agents.tuning.search_space import (
    Space,
    chosen_values,
    proposals_of,
    search_space,
    with_values,
)
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed
from dq_marine.util.side_by_side import workers

with extra_needed("a search for hyperparameters", "tune"):
    import optuna
    from optuna.trial import FrozenTrial, TrialState

MOST_PROCESSES = 256
EVALUATIONS = 8
"""While a trial trains, at least: it may be given up after each."""

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


def plan_of(settings: TrainingSettings, *, seed: int) -> StudyPlan:
    """Return a search that begins from a training, evaluated often enough for trials to be given up.

    Raises:
        InvalidInputError: the seed is too large, there is a curriculum, or see `check_can_begin`.
    """
    seed = whole_number("seed", seed, least=0, most=LARGEST_SEED)
    if settings.curriculum is not None:
        raise InvalidInputError(
            f"curriculum.levels = {list(settings.curriculum.levels)}: trials learn at one level, so that their returns "
            "can be compared; leave [curriculum] out"
        )
    check_can_begin(settings)
    every = max(1, min(settings.evaluation.every, settings.timesteps // EVALUATIONS))
    evaluation = settings.evaluation.model_copy(update={"every": every})
    return StudyPlan(settings.model_copy(update={"evaluation": evaluation}), seed)


def tune(
    folder: StudyFolder,
    plan: StudyPlan,
    *,
    trials: int,
    processes: int = 1,
    after: Callable[[list[Tried]], None] = lambda tried: None,
) -> list[Tried]:
    """Search until so many trials have ended in all, and return them, the best first.

    With one process and one seed the trials are the same each time, stopped or not; several processes propose by what
    has ended so far.

    Args:
        folder: of the study: new, or one to go on with.
        plan: what is searched.
        trials: in all, with those of before.
        processes: that train at a time.
        after: called with all trials that have ended, whenever one has.

    Raises:
        InvalidInputError: a number is wrong, or another study is in the folder.
    """
    trials = whole_number("trials", trials, least=1)
    processes = whole_number("processes", processes, least=1, most=MOST_PROCESSES)
    with folder.begun(plan):
        study = _study(folder, plan)
        _take_up(study, plan)
        coming = range(len(_ended(study)), trials)
        if min(processes, len(coming)) <= 1:
            for index in coming:
                _try(folder, index, _asked(study))
                after(tried(study, plan))
        else:
            _try_side_by_side(folder, coming, min(processes, len(coming)), study, after)
        return tried(study, plan)


def tried(study: optuna.Study, plan: StudyPlan) -> list[Tried]:
    """Return the trials that ended, the best first, failed ones last."""
    space = search_space(plan.base)
    return sorted(
        (_tried(trial, space) for trial in _ended(study)),
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


def _study(folder: StudyFolder, plan: StudyPlan, index: int = 0) -> optuna.Study:
    """Return the study on disk, made if need be, with the sampler of its trial of that index.

    A sampler of each trial's own, so that a search that was stopped goes on as if it had not been.
    """
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    warmup = int(UNJUDGED_SHARE * plan.base.timesteps)
    return optuna.create_study(
        study_name="study",
        storage=f"sqlite:///{folder.database.resolve()}",
        load_if_exists=True,
        direction="maximize",
        sampler=optuna.samplers.TPESampler(seed=(plan.seed + index) % (LARGEST_SEED + 1)),
        pruner=optuna.pruners.MedianPruner(n_startup_trials=UNJUDGED_TRIALS, n_warmup_steps=warmup),
    )


def _take_up(study: optuna.Study, plan: StudyPlan) -> None:
    """Have the training as it is tried first, and again what a killed process left behind."""
    if not study.trials:
        study.enqueue_trial(proposals_of(plan.base, search_space(plan.base)))
    for trial in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
        study.enqueue_trial(trial.params, user_attrs={AGAIN: trial.number})
        study.tell(trial.number, state=TrialState.FAIL)


def _ended(study: optuna.Study) -> list[FrozenTrial]:
    """Return the trials that ended, without those that are tried again."""
    trials = study.get_trials(deepcopy=False)
    again = {trial.user_attrs.get(AGAIN) for trial in trials}
    return [trial for trial in trials if trial.state.is_finished() and trial.number not in again]


def _asked(study: optuna.Study) -> int:
    """Return the number of another trial to be trained.

    Only the process that hands trials out asks for them: two that ask at once may be given the same one that waits.
    """
    return study.ask().number


def _try(folder: StudyFolder, index: int, number: int) -> None:
    """Train one trial to its end, or until it is given up."""
    plan = folder.read_plan()
    space, study = search_space(plan.base), _study(folder, plan, index)
    trial = optuna.Trial(study, study.get_trials(deepcopy=False)[number]._trial_id)

    def tell(timesteps: int, mean_return: float) -> None:
        trial.report(mean_return, timesteps)
        if trial.should_prune():
            raise optuna.TrialPruned

    try:
        settings = with_values(plan.base, chosen_values(space, trial))
        found = _trial_return(settings, plan.seed, folder, number, tell)
    except optuna.TrialPruned:
        study.tell(trial, state=TrialState.PRUNED)
    except FAILURES:
        study.tell(trial, state=TrialState.FAIL)
    else:
        study.tell(trial, found)


def _trial_return(
    settings: TrainingSettings,
    seed: int,
    folder: StudyFolder,
    number: int,
    tell: Callable[[int, float], None],
) -> float:
    from dq_marine.agents.tuning.trial import trial_return  # here: it imports torch

    return trial_return(settings, seed=seed, logs=folder.tensorboard / f"trial{number:04d}", tell=tell)


def _try_side_by_side(
    folder: StudyFolder,
    coming: range,
    processes: int,
    study: optuna.Study,
    after: Callable[[list[Tried]], None],
) -> None:
    """Train so many trials at a time, and say so whenever one has ended.

    One that has ended makes room for the next, so that none is begun that was not asked for.
    """
    plan = folder.read_plan()
    with workers(processes) as pool:
        waiting = iter(coming)

        def begin(count: int) -> set[Future[None]]:
            return {pool.submit(_try, folder, index, _asked(study)) for index in islice(waiting, count)}

        working = begin(processes)
        while working:
            done, working = wait(working, return_when=FIRST_COMPLETED)
            for one in done:
                one.result()
            working |= begin(len(done))
            after(tried(study, plan))
