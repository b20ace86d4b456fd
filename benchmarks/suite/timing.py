"""Timing that says what it is: cases warmed up, measured in turn, with the garbage collector off."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from dq_marine.report.timing import no_garbage_collection, rounded

LEAST = 0.02
"""Shortest time [s] that a sample is taken over."""

Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True)
class Timing:
    """Samples of one case.

    Attributes:
        samples: seconds a unit, in the order they were taken.
        cores: processor time over wall time, of all samples together: how many cores the process had.
    """

    samples: tuple[float, ...]
    cores: float

    @property
    def best(self) -> float:
        """Shortest sample [s]."""
        return min(self.samples)

    @property
    def median(self) -> float:
        """Middle sample [s]."""
        return statistics.median(self.samples)

    def row(self) -> dict[str, Any]:
        """Return the numbers as they are recorded, times in nanoseconds."""
        return {
            "best_ns": rounded(self.best * 1e9),
            "median_ns": rounded(self.median * 1e9),
            "samples_ns": [rounded(sample * 1e9) for sample in self.samples],
            "cores": rounded(self.cores),
        }


class Case:
    """Something to time.

    Args:
        call: what is timed.
        units: how many units of work (steps of a body, steps of an environment) one call does.
        before: what is done before every call, untimed.
    """

    def __init__(self, call: Callable[[], Any], units: int, before: Callable[[], Any] | None = None) -> None:
        self._call = call
        self._units = units
        self._before = before
        self._calls = 1

    def prepare(self) -> None:
        """Warm up, and find how many calls fill a sample."""
        self._elapsed(1)
        elapsed = self._elapsed(1)
        while elapsed < LEAST:
            self._calls = max(self._calls + 1, int(1.2 * self._calls * LEAST / elapsed))
            elapsed = self._elapsed(self._calls)

    def sample(self) -> float:
        """Return seconds a unit, over one sample."""
        return self._elapsed(self._calls) / (self._calls * self._units)

    def _elapsed(self, calls: int) -> float:
        if self._before is None:
            start = time.perf_counter()
            for _ in range(calls):
                self._call()
            return time.perf_counter() - start
        total = 0.0
        for _ in range(calls):
            self._before()
            start = time.perf_counter()
            self._call()
            total += time.perf_counter() - start
        return total


def compare(cases: Mapping[Key, Case], rounds: int, progress: Callable[[float], None]) -> dict[Key, Timing]:
    """Return timings of cases measured in turn: A B C A B C ..., so that drifts of the machine meet all alike.

    Args:
        cases: by name.
        rounds: samples of each case.
        progress: is told, between rounds, what part is done.
    """
    for case in cases.values():
        case.prepare()
    samples: dict[Key, list[float]] = {key: [] for key in cases}
    wall, cores = dict.fromkeys(cases, 0.0), dict.fromkeys(cases, 0.0)
    with no_garbage_collection():
        for done in range(rounds):
            progress((done + 1) / (rounds + 1))  # warming up took about as long as a round
            for key, case in cases.items():
                began, used = time.perf_counter(), time.process_time()
                samples[key].append(case.sample())
                cores[key] += time.process_time() - used
                wall[key] += time.perf_counter() - began
    return {key: Timing(tuple(samples[key]), cores[key] / wall[key]) for key in cases}
