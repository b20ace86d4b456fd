"""Trials on a cluster: machines train, and the process that searches asks and tells the study, which it alone opens.

So the study stays in SQLite on the disk of one machine, and a search goes on with a cluster or without. After each
evaluation a trial asks whether it is to be given up, and waits for the answer.
"""

from __future__ import annotations

from concurrent.futures import FIRST_COMPLETED, Future, wait
from itertools import islice
from typing import TypeAlias

from dq_marine.agents.tuning.search_space import chosen_values, search_space, with_values
from dq_marine.agents.tuning.study import FAILURES, sampler_of, tried
from dq_marine.agents.tuning.study_folder import StudyFolder, StudyPlan
from dq_marine.agents.tuning.trial_elsewhere import try_elsewhere
from dq_marine.agents.tuning.tuning import After, Way
from dq_marine.util.cluster import Cluster, ClusterPool
from dq_marine.util.cluster_desk import Desk
from dq_marine.util.extras import extra_needed

with extra_needed("a search for hyperparameters", "tune"):
    import optuna
    from optuna.trial import TrialState

GLANCE = 0.2
"""Between two looks at what trials ask [s]."""

Found: TypeAlias = "Future[float | None]"
"""What a trial's best mean return will be; None if it was given up."""


def on_cluster(cluster: Cluster, at_once: int | None = None) -> Way:
    """Return the way that trains trials on a cluster.

    Args:
        cluster: what lets one work within a block.
        at_once: how many trials, at most; None for as many as it has processors.
    """

    def way(folder: StudyFolder, plan: StudyPlan, coming: range, study: optuna.Study, after: After) -> None:
        with cluster() as pool:
            search, waiting = _Search(folder, plan, study, pool), iter(coming)
            while True:
                room = min(pool.processors(), at_once or len(coming)) - len(search.working)
                for index in islice(waiting, max(room, 0)):
                    search.begin(index)
                if not search.working:
                    break
                done, _ = wait(search.working, timeout=GLANCE, return_when=FIRST_COMPLETED)
                search.answer()
                for one in done:
                    search.end(one)
                if done:
                    after(tried(study, plan))

    return way


class _Search:
    """The trials that are trained at the moment."""

    def __init__(self, folder: StudyFolder, plan: StudyPlan, study: optuna.Study, pool: ClusterPool) -> None:
        self._folder, self._plan, self._study, self._pool = folder.path.resolve(), plan, study, pool
        self._desk: Desk = pool.desk()
        self._told: dict[int, int] = {}
        self.working: dict[Found, optuna.Trial] = {}

    def begin(self, index: int) -> None:
        """Have another trial trained somewhere."""
        plan, study = self._plan, self._study
        study.sampler = sampler_of(plan, index)
        trial = study.ask()
        try:
            settings = with_values(plan.base, chosen_values(search_space(plan.base), trial))
        except FAILURES as error:
            found: Found = Future()
            found.set_exception(error)
        else:
            found = self._pool.submit(try_elsewhere, self._folder, plan, settings, trial.number, self._desk)
        self.working[found] = trial

    def answer(self) -> None:
        """Say to trials that ask whether they are to be given up."""
        trials = {trial.number: trial for trial in self.working.values()}
        for number, (timesteps, mean_return) in self._desk.waiting().items():
            self._desk.answer(
                number, number in trials and self._judged(trials[number], timesteps, mean_return)
            )

    def _judged(self, trial: optuna.Trial, timesteps: int, mean_return: float) -> bool:
        if timesteps <= self._told.get(trial.number, -1):
            return False  # it was begun again on another machine, and has asked this before
        self._told[trial.number] = timesteps
        trial.report(mean_return, timesteps)
        return bool(trial.should_prune())

    def end(self, found: Found) -> None:
        """Tell the study how a trial ended.

        Raises:
            MissingDependencyError: a library that learns is not installed where it was to be trained.
        """
        trial = self.working.pop(found)
        try:
            mean_return = found.result()
        except FAILURES:
            self._study.tell(trial, state=TrialState.FAIL)
        else:
            if mean_return is None:
                self._study.tell(trial, state=TrialState.PRUNED)
            else:
                self._study.tell(trial, mean_return)
