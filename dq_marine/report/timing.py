"""Timing that says what it is: calls warmed up, measured in turn, with the garbage collector off."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

Key = TypeVar("Key", bound=Hashable)

LEAST = 0.002
"""Shortest time that a sample is taken over, unless a comparison asks for more [s]."""


@dataclass(frozen=True)
class Timing:
    """Samples of one call.

    Attributes:
        samples: seconds a unit of work, in the order they were taken.
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

    def per(self, units: float) -> Timing:
        """Return the same for each of so many units of work that the call did."""
        return Timing(tuple(sample / units for sample in self.samples), self.cores)

    def row(self) -> dict[str, Any]:
        """Return the shortest and the middle sample, in nanoseconds."""
        return {"best_ns": rounded(self.best * 1e9), "median_ns": rounded(self.median * 1e9)}

    def full_row(self) -> dict[str, Any]:
        """Return all samples as well, and how many cores there were."""
        samples = [rounded(sample * 1e9) for sample in self.samples]
        return {**self.row(), "samples_ns": samples, "cores": rounded(self.cores)}


class Timed:
    """Something to time.

    Args:
        call: what is timed.
        units: how many units of work (steps, simulated seconds) one call does.
        before: what is done before every call, untimed.
    """

    def __init__(
        self, call: Callable[[], Any], units: float, before: Callable[[], Any] | None = None
    ) -> None:
        self._call = call
        self._units = units
        self._before = before
        self._calls = 1

    def prepare(self, least: float) -> None:
        """Warm up, and find how many calls fill a sample of at least so many seconds."""
        self._elapsed(1)
        elapsed = self._elapsed(1)
        while elapsed < least:
            self._calls = max(self._calls + 1, int(1.2 * self._calls * least / max(elapsed, 1e-9)))
            elapsed = self._elapsed(self._calls)

    def sample(self) -> float:
        """Return seconds a unit of work, over one sample."""
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


def compare(
    cases: Mapping[Key, Timed],
    rounds: int,
    *,
    least: float = LEAST,
    progress: Callable[[float], None] = lambda _: None,
) -> dict[Key, Timing]:
    """Return timings of cases measured in turn, A B C A B C ...: drifts of the machine meet all alike.

    Args:
        cases: by name.
        rounds: samples of each case.
        least: shortest time that a sample is taken over [s].
        progress: is told, between rounds, what part is done.
    """
    for case in cases.values():
        case.prepare(least)
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


@contextmanager
def no_garbage_collection() -> Iterator[None]:
    """Collect garbage now, and not again before the block ends."""
    gc.collect()
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def rounded(value: float) -> float:
    """Return a number to five digits, more than a timing has."""
    return float(f"{value:.5g}")
