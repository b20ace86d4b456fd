"""Search for hyperparameters by Optuna, in one process, several or on a cluster, which goes on where it was stopped.

The first trial is the training as it is, so that the best is no worse. Others are proposed by a tree-structured Parzen
estimator (Bergstra et al. 2011, NeurIPS), and given up where they are worse than the median of those before (Golovin et
al. 2017, KDD). The return counts that the run would keep: of its best evaluation.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from itertools import islice
from typing import TypeAlias

from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.training.beginning import check_can_begin
from dq_marine.agents.training.run_folder import LARGEST_SEED
from dq_marine.agents.tuning.search_space import chosen_values, search_space, with_values
from dq_marine.agents.tuning.study import FAILURES, Tried, asked, ended, study_on_disk, take_up, tried
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import extra_needed
from dq_marine.util.side_by_side import workers

with extra_needed("a search for hyperparameters", "tune"):
    import optuna
    from optuna.trial import TrialState

MOST_PROCESSES = 256
EVALUATIONS = 8
"""While a trial trains, at least: it may be given up after each."""

After: TypeAlias = Callable[[list[Tried]], None]
"""Called with all trials that have ended, whenever one has."""

Way: TypeAlias = "Callable[[StudyFolder, StudyPlan, range, optuna.Study, After], None]"
"""(folder, plan, which trials, counted from 0, study, after): trains trials, and tells the study how they ended."""


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
    way: Way | None = None,
    after: After = lambda tried: None,
) -> list[Tried]:
    """Search until so many trials have ended in all, and return them, the best first.

    With one process and one seed the trials are the same each time, stopped or not; several processes propose by what
    has ended so far.

    Args:
        folder: of the study: new, or one to go on with.
        plan: what is searched.
        trials: in all, with those of before.
        processes: of this machine that train at a time.
        way: how trials are trained instead, as `cluster_trials.on_cluster` makes it.
        after: called with all trials that have ended, whenever one has.

    Raises:
        InvalidInputError: a number is wrong, or another study is in the folder.
    """
    trials = whole_number("trials", trials, least=1)
    processes = whole_number("processes", processes, least=1, most=MOST_PROCESSES)
    with folder.begun(plan):
        study = study_on_disk(folder, plan)
        take_up(study, plan)
        coming = range(len(ended(study)), trials)
        if coming:
            (way or _by_processes(min(processes, len(coming))))(folder, plan, coming, study, after)
        return tried(study, plan)


def _try(folder: StudyFolder, index: int, number: int) -> None:
    """Train one trial to its end, or until it is given up."""
    plan = folder.read_plan()
    space, study = search_space(plan.base), study_on_disk(folder, plan, index)
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


def _by_processes(count: int) -> Way:
    """Return the way that trains with this process, or so many others."""

    def side_by_side(
        folder: StudyFolder, plan: StudyPlan, coming: range, study: optuna.Study, after: After
    ) -> None:
        with workers(count) as pool:
            waiting = iter(coming)

            # One that has ended makes room for the next, so that none is begun that was not asked for.
            def begin(room: int) -> set[Future[None]]:
                return {pool.submit(_try, folder, index, asked(study)) for index in islice(waiting, room)}

            working = begin(count)
            while working:
                done, working = wait(working, return_when=FIRST_COMPLETED)
                for one in done:
                    one.result()
                working |= begin(len(done))
                after(tried(study, plan))

    return side_by_side if count > 1 else _one_after_the_other


def _one_after_the_other(
    folder: StudyFolder, plan: StudyPlan, coming: range, study: optuna.Study, after: After
) -> None:
    for index in coming:
        _try(folder, index, asked(study))
        after(tried(study, plan))
