"""Trials elsewhere: the study stays with the process that searches, which answers whether trials are to be given up."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from support.command_line import assert_refused, run
from support.trainings import tiny

from dq_marine.agents.tuning import trial
from dq_marine.agents.tuning.cluster_trials import on_cluster
from dq_marine.agents.tuning.study_folder import StudyFolder
from dq_marine.agents.tuning.trial_elsewhere import try_elsewhere
from dq_marine.agents.tuning.tuning import plan_of, tune


class DeskHere:
    """Does what a cluster's desk does, between threads."""

    def __init__(self) -> None:
        self._asked: dict[int, Any] = {}
        self._replies: dict[int, Any] = {}
        self._changed = threading.Condition()

    def ask(self, number: int, what: Any) -> Any:
        with self._changed:
            self._asked[number] = what
            assert self._changed.wait_for(lambda: number in self._replies, timeout=60.0)
            return self._replies.pop(number)

    def waiting(self) -> dict[int, Any]:
        with self._changed:
            return dict(self._asked)

    def answer(self, number: int, reply: Any) -> None:
        with self._changed:
            del self._asked[number]
            self._replies[number] = reply
            self._changed.notify_all()


class PoolHere(ThreadPoolExecutor):
    """Does what a cluster does, in threads, of which there are more than processors."""

    def __init__(self, count: int) -> None:
        super().__init__(count + 2)
        self._count = count

    def desk(self) -> DeskHere:
        return DeskHere()

    def processors(self) -> int:
        return self._count


def threads(count: int) -> Callable[[], Any]:
    @contextlib.contextmanager
    def cluster() -> Iterator[PoolHere]:
        with PoolHere(count) as pool:
            yield pool

    return cluster


GOOD, BAD = [5.0, 6.0, 7.0, 8.0] * 2, [1.0] * 8


def returns(values: dict[int, list[float]], begun: list[int]) -> Callable[..., float]:
    """A training whose evaluations return what stands in a table, by the number of the trial."""

    def trial_return(settings: Any, *, seed: int, logs: Path, tell: Callable[[int, float], None]) -> float:
        number = int(logs.name.removeprefix("trial"))
        begun.append(number)
        for index, value in enumerate(values.get(number, GOOD)):
            if value != value:
                raise ValueError("not finite")
            tell((index + 1) * settings.evaluation.every, value)
        return max(values.get(number, GOOD))

    return trial_return


def test_the_worse_are_given_up_and_failures_do_not_end_the_search(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[int] = []
    values = {2: [float("nan")], 5: BAD, 6: [9.0] * 8}
    monkeypatch.setattr(trial, "trial_return", returns(values, begun))
    plan, told = plan_of(tiny(tmp_path, "ppo", 256), seed=0), list[int]()
    found = tune(
        StudyFolder(tmp_path / "study"),
        plan,
        trials=7,
        way=on_cluster(threads(1)),
        after=lambda tried: told.append(len(tried)),
    )
    assert told == [1, 2, 3, 4, 5, 6, 7]
    by_number = {one.number: one for one in found}
    assert sorted(by_number) == list(range(7)) == sorted(begun)
    assert found[0].number == 6
    assert by_number[5].given_up
    assert by_number[5].timesteps < 256
    assert by_number[2].mean_return is None
    assert [one.number for one in found if one.given_up or one.mean_return is None] == [5, 2]


def test_one_at_a_time_the_trials_are_those_of_one_process(tmp_path: Path) -> None:
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=3)
    here = tune(StudyFolder(tmp_path / "here"), plan, trials=2)
    spread = StudyFolder(tmp_path / "spread")
    tune(spread, plan, trials=1, way=on_cluster(threads(3), 1))
    assert tune(spread, plan, trials=2, way=on_cluster(threads(3), 1)) == here
    assert len(list(spread.tensorboard.iterdir())) == 2


def test_no_more_train_at_a_time_than_there_are_processors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    together, working, most = threading.Barrier(2), list[str](), list[int]()

    def trial_return(settings: Any, *, seed: int, logs: Path, tell: Callable[[int, float], None]) -> float:
        working.append(logs.name)
        most.append(len(working))
        together.wait(timeout=60.0)
        working.remove(logs.name)
        return 1.0

    monkeypatch.setattr(trial, "trial_return", trial_return)
    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=0)
    found = tune(StudyFolder(tmp_path / "study"), plan, trials=4, way=on_cluster(threads(2)))
    assert max(most) == 2
    assert sorted(one.number for one in found) == list(range(4))


def test_what_was_begun_again_is_not_judged_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first machine of trial 4 was lost after three evaluations, and another begins with the first one."""
    ended: list[str] = []

    def trial_return(settings: Any, *, seed: int, logs: Path, tell: Callable[[int, float], None]) -> float:
        lost = logs.name == "trial0004"
        for index in [0, 1, 2, 0, 1, 2, 3] if lost else range(8):
            tell((index + 1) * 32, 6.0 + index)
        ended.append(logs.name)
        return 9.0

    monkeypatch.setattr(trial, "trial_return", trial_return)
    plan = plan_of(tiny(tmp_path, "ppo", 256), seed=0)
    found = tune(StudyFolder(tmp_path / "study"), plan, trials=5, way=on_cluster(threads(1)))
    assert len(ended) == 5
    assert not any(one.given_up for one in found)
    assert {one.number: one.timesteps for one in found}[4] == 128


def test_a_machine_that_does_not_see_the_study_leaves_no_logs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    class Answers:
        def ask(self, number: int, what: Any) -> bool:
            asked.append((number, what))
            return len(asked) > 1

    plan = plan_of(tiny(tmp_path, "ppo", 64), seed=0)
    nowhere: Any = Answers()
    assert try_elsewhere(tmp_path / "nowhere", plan, plan.base, 3, nowhere) is None
    assert [number for number, _ in asked] == [3, 3]
    assert not (tmp_path / "nowhere").exists()


def test_an_address_needs_a_cluster(tmp_path: Path) -> None:
    refused = run("tune", "--out", tmp_path / "study", "--address", "h:1")
    assert_refused(refused, "--address h:1 needs --distributed; give both, or neither")
    assert not (tmp_path / "study").exists()
