"""Searches with tiny trainings: the same each time, stopped and gone on with, side by side, written down."""

from __future__ import annotations

import csv
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import optuna
import pytest
from optuna.trial import TrialState
from support.sweeps import sweep
from support.trainings import preset, tiny

from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrainingSettings
from dq_marine.agents.tuning import tuning
from dq_marine.agents.tuning.results import write_results
from dq_marine.agents.tuning.search_space import search_space, with_values
from dq_marine.agents.tuning.study import Tried
from dq_marine.agents.tuning.study_folder import StudyFolder
from dq_marine.agents.tuning.tuning import plan_of, tune
from dq_marine.errors import InvalidInputError


@pytest.mark.sweep
def test_a_search_is_the_same_stopped_or_not_and_begins_with_the_preset(tmp_path: Path) -> None:
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=3)
    first = tune(StudyFolder(tmp_path / "whole"), plan, trials=3)
    tune(StudyFolder(tmp_path / "stopped"), plan, trials=1)
    assert tune(StudyFolder(tmp_path / "stopped"), plan, trials=3) == first
    assert sorted(one.number for one in first) == [0, 1, 2]
    (base,) = (one for one in first if one.number == 0)
    assert base.values["algorithm.learning_rate"] == plan.base.algorithm.learning_rate
    assert len({one.values["algorithm.learning_rate"] for one in first}) == 3
    ended = [one.mean_return for one in first if one.mean_return is not None and not one.given_up]
    assert ended == sorted(ended, reverse=True)


def returns(values: dict[int, list[float]]):
    """A training whose evaluations return what stands in a table, by the number of the trial."""

    def trial_return(settings, seed, folder, number, tell) -> float:
        for i, value in enumerate(values[number]):
            if value != value:
                raise ValueError("not finite")
            tell((i + 1) * settings.evaluation.every, value)
        return max(values[number])

    return trial_return


def test_the_worse_are_given_up_and_failures_do_not_end_the_search(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good, bad, nan = [5.0, 6.0, 7.0, 8.0] * 2, [1.0] * 8, float("nan")
    values = {0: good, 1: good, 2: [nan], 3: good, 4: good, 5: bad, 6: [9.0] * 8}
    monkeypatch.setattr(tuning, "_trial_return", returns(values))
    plan = plan_of(tiny(tmp_path, "ppo", 256), seed=0)
    told: list[int] = []
    found = tune(StudyFolder(tmp_path / "study"), plan, trials=7, after=lambda tried: told.append(len(tried)))
    assert told == [1, 2, 3, 4, 5, 6, 7]
    assert (found[0].number, found[0].mean_return) == (6, 9.0)
    by_number = {one.number: one for one in found}
    assert by_number[5].given_up
    assert by_number[5].timesteps < 256
    assert not any(one.given_up for one in found if one.number != 5)
    assert by_number[2].mean_return is None
    assert found[-1].number == 2


@pytest.mark.sweep
def test_what_a_killed_search_left_behind_is_tried_again(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path / "study")
    arguments = ["--out", str(folder.path), "--preset", str(preset(tmp_path, "ppo", 4096)), "--trials", "3"]
    command = [sys.executable, "-m", "dq_marine", "tune", *arguments, "--processes", "1", "--seed", "1"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 300.0
        while not list(folder.tensorboard.glob("trial0000/*")):
            assert process.poll() is None, "it ended before its first trial"
            assert time.monotonic() < deadline
            time.sleep(0.05)
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    found = tune(folder, folder.read_plan(), trials=1)
    assert [one.number for one in found] == [1]
    assert found[0].values["algorithm.learning_rate"] == folder.read_plan().base.algorithm.learning_rate
    study = optuna.load_study(study_name="study", storage=f"sqlite:///{folder.database}")
    assert [trial.state for trial in study.trials] == [TrialState.FAIL, TrialState.COMPLETE]
    assert tune(folder, folder.read_plan(), trials=1) == found, "nothing is left to be tried"


@pytest.mark.sweep
def test_several_processes_try_as_many_as_were_asked_for(tmp_path: Path) -> None:
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=3)
    told: list[int] = []
    found = tune(
        StudyFolder(tmp_path / "study"),
        plan,
        trials=5,
        processes=2,
        after=lambda tried: told.append(len(tried)),
    )
    assert sorted(one.number for one in found) == list(range(5))
    assert told[-1] == 5
    assert told == sorted(told)


@pytest.mark.parametrize("repetition", sweep(range(4), plain=[0]))
def test_trials_that_begin_or_end_together_are_those_that_were_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, repetition: int
) -> None:
    """None twice, and none more: two that ask for a trial at once could be given the same one, now and then."""
    together, begun = threading.Barrier(4), []

    def trial_return(settings, seed, folder, number, tell) -> float:
        begun.append(number)
        if len(begun) <= 4:
            together.wait(timeout=60.0)
        return 1.0

    monkeypatch.setattr(tuning, "_trial_return", trial_return)
    monkeypatch.setattr(tuning, "workers", ThreadPoolExecutor)
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=repetition)
    found = tune(StudyFolder(tmp_path / "study"), plan, trials=5, processes=4)
    assert sorted(begun) == sorted(one.number for one in found) == list(range(5))


@pytest.mark.parametrize("algorithm", [pytest.param("ppo", marks=pytest.mark.sweep), "sac"])
def test_results_are_read_back(tmp_path: Path, algorithm: str) -> None:
    folder, plan = StudyFolder(tmp_path / "study"), plan_of(tiny(tmp_path, algorithm, 64), seed=0)
    found = tune(folder, plan, trials=2)
    written = write_results(folder, plan, found)
    assert written == [folder.trials, folder.preset, folder.picture]
    assert folder.picture.stat().st_size > 10_000
    best = read_settings(folder.preset, TrainingSettings)
    assert best == with_values(plan.base, found[0].values)
    rows = list(csv.DictReader(folder.trials.read_text(encoding="utf-8").splitlines()))
    assert [int(row["trial"]) for row in rows] == [one.number for one in found]
    for row, one in zip(rows, found, strict=True):
        for name, value in one.values.items():
            assert row[name] == (" ".join(map(str, value)) if isinstance(value, list) else str(value))


def test_without_a_trial_that_ended_there_is_no_preset(tmp_path: Path) -> None:
    folder, plan = StudyFolder(tmp_path), plan_of(tiny(tmp_path, "ppo", 64), seed=0)
    assert write_results(folder, plan, []) == [folder.trials]
    values = dict.fromkeys(search_space(plan.base))
    values["network.layers"], values["algorithm.learning_rate"] = [8], 0.1
    failed = Tried(0, None, 0, False, values)
    assert write_results(folder, plan, [failed]) == [folder.trials]
    given_up = Tried(1, 2.0, 32, True, values)
    assert write_results(folder, plan, [given_up, failed]) == [folder.trials, folder.picture]


def test_another_study_in_the_folder_is_named_and_left(tmp_path: Path) -> None:
    folder, plan = StudyFolder(tmp_path / "study"), plan_of(tiny(tmp_path, "ppo", 64), seed=0)
    tune(folder, plan, trials=1)
    other = plan_of(tiny(tmp_path, "ppo", 128), seed=1)
    with pytest.raises(
        InvalidInputError, match=r"holds another study: .*seed is 0, not 1; timesteps is 64, not 128"
    ):
        tune(folder, other, trials=2)
    assert len(tune(folder, plan, trials=1)) == 1


def test_what_is_no_study_is_refused_and_left(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=0)
    with pytest.raises(InvalidInputError, match="exists and is not a study"):
        tune(StudyFolder(tmp_path), plan, trials=1)
    with pytest.raises(InvalidInputError, match="holds no study"):
        StudyFolder(tmp_path).read_plan()
    (tmp_path / "study.json").write_text("{")
    with pytest.raises(InvalidInputError, match="is damaged"):
        StudyFolder(tmp_path).read_plan()
    with pytest.raises(InvalidInputError, match="trials = 0"):
        tune(StudyFolder(tmp_path / "new"), plan, trials=0)
    with pytest.raises(InvalidInputError, match="seed = -1"):
        plan_of(plan.base, seed=-1)
    assert not (tmp_path / "new").exists()
