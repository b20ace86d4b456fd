"""What was measured is kept, an interrupted run goes on, and nothing stale is taken for new."""

from __future__ import annotations

from pathlib import Path

import pytest
from rich.console import Console
from support.timings import without_timings

from dq_marine.report import sources
from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.runner import InterruptedRunError, measure, measured
from dq_marine.report.store import Store

QUIET = Console(quiet=True)
PLAN = Plan(quick=True)


class Bench:
    """A study of three units that remembers what it ran, and can be interrupted."""

    def __init__(self) -> None:
        self.ran: list[str] = []
        self.interrupted_at = ""
        self.setting = 1
        self.study = Study("bench", "Bench", "", self.units, self.nothing, self.nothing, self.nothing)

    def nothing(self, rows: Rows) -> list:
        return []

    def units(self, plan: Plan) -> list[Unit]:
        return [
            Unit(
                name,
                lambda name=name: self.run(name),
                {"setting": self.setting, "pair": (1, 2)},
                group="ab" if name in "ab" else "c",
            )
            for name in "abc"
        ]

    def run(self, name: str) -> Rows:
        if name == self.interrupted_at:
            raise KeyboardInterrupt
        self.ran.append(name)
        return [{"name": name, "error": 1.0 / 3.0, "best_ns": float(len(self.ran))}]

    def measure(self, store: Store, *, fresh: bool = False) -> list[str]:
        """Return what a run measured."""
        self.ran.clear()
        measure([self.study], PLAN, store, QUIET, fresh=fresh)
        return list(self.ran)


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(tmp_path, PLAN)


def test_an_interrupted_run_goes_on_where_it_stopped(bench: Bench, store: Store, tmp_path: Path) -> None:
    bench.interrupted_at = "c"
    with pytest.raises(InterruptedRunError) as stopped:
        bench.measure(store)
    assert (stopped.value.measured, stopped.value.wanted) == (2, 3)
    bench.interrupted_at = ""
    assert bench.measure(Store(tmp_path, PLAN)) == ["c"]
    assert bench.measure(Store(tmp_path, PLAN)) == []


def test_fresh_measures_again(bench: Bench, store: Store) -> None:
    bench.measure(store)
    assert bench.measure(store, fresh=True) == ["a", "b", "c"]


def test_other_settings_are_measured_again(bench: Bench, store: Store) -> None:
    bench.measure(store)
    bench.setting = 2
    assert bench.measure(store) == ["a", "b", "c"]


def test_other_sources_are_measured_again(
    bench: Bench, store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.measure(store)
    monkeypatch.setattr(sources, "source_fingerprint", lambda: "changed")
    assert bench.measure(Store(tmp_path, PLAN)) == ["a", "b", "c"]


def test_a_damaged_unit_is_measured_again(bench: Bench, store: Store) -> None:
    bench.measure(store)
    (store.folder / "bench" / "b.json").write_text('{"stamp": {}, "rows"')
    (store.folder / "bench" / "c.json").write_text("[1, 2]")
    assert bench.measure(store) == ["b", "c"]


def test_quick_full_and_seeds_are_kept_apart(bench: Bench, tmp_path: Path) -> None:
    bench.measure(Store(tmp_path, PLAN))
    for plan in (Plan(quick=False), Plan(quick=True, seed=1)):
        assert measured([bench.study], plan, Store(tmp_path, plan)) == {}
    assert list(measured([bench.study], PLAN, Store(tmp_path, PLAN))) == ["bench"]


def test_a_group_is_shown_whole_or_not_at_all(bench: Bench, store: Store) -> None:
    """Errors without times, say, would read as if a method got nowhere."""
    bench.measure(store)
    (store.folder / "bench" / "b.json").unlink()
    assert [row["name"] for row in measured([bench.study], PLAN, store)["bench"]] == ["c"]
    (store.folder / "bench" / "c.json").unlink()
    assert measured([bench.study], PLAN, store) == {}


def test_rows_read_are_those_written(bench: Bench, store: Store) -> None:
    bench.measure(store)
    rows = measured([bench.study], PLAN, store)["bench"]
    assert [row["name"] for row in rows] == ["a", "b", "c"]
    assert rows[0]["error"] == 1.0 / 3.0
    assert without_timings(rows)[0] == {"name": "a", "error": 1.0 / 3.0}


def test_a_folder_is_left_without_half_files(bench: Bench, store: Store) -> None:
    bench.interrupted_at = "b"
    with pytest.raises(InterruptedRunError):
        bench.measure(store)
    assert [path.name for path in store.folder.rglob("*.json")] == ["a.json"]
    assert list(store.folder.rglob(".*")) == []
