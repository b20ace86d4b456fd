"""What is timed is warmed up, fills a sample, and is measured in turn without the garbage collector."""

from __future__ import annotations

import gc
import time

import pytest

from dq_marine.report.timing import Timed, Timing, compare, rounded


def test_samples_are_seconds_a_unit_and_what_is_before_a_call_is_not_timed() -> None:
    timed = Timed(lambda: time.sleep(0.002), 4, before=lambda: time.sleep(0.02))
    timed.prepare(least=0.001)
    assert 0.0005 <= timed.sample() < 0.004


@pytest.mark.parametrize("before", [None, lambda: None])
def test_a_sample_takes_the_least_time_or_more(before) -> None:
    calls = []
    timed = Timed(lambda: calls.append(time.perf_counter()), 1, before)
    timed.prepare(least=0.005)
    calls.clear()
    timed.sample()
    assert len(calls) > 100


def test_cases_are_measured_in_turn_without_the_collector() -> None:
    order: list[str] = []
    collected: list[bool] = []

    def case(name: str) -> Timed:
        def call() -> None:
            order.append(name)
            collected.append(gc.isenabled())
            time.sleep(0.001)

        return Timed(call, 1)

    told: list[float] = []
    timings = compare({"a": case("a"), "b": case("b")}, 3, least=0.0, progress=told.append)
    assert "".join(order[-6:]) == "ababab"
    assert not any(collected[-6:])
    assert gc.isenabled()
    assert told == [0.25, 0.5, 0.75]
    assert all(len(timing.samples) == 3 for timing in timings.values())


def test_rows_have_the_best_and_the_middle_sample() -> None:
    timing = Timing((3e-9, 1e-9, 2e-9), 0.5)
    assert timing.row() == {"best_ns": 1.0, "median_ns": 2.0}
    assert timing.full_row() == {**timing.row(), "samples_ns": [3.0, 1.0, 2.0], "cores": 0.5}
    assert rounded(123456.789) == 123460.0
