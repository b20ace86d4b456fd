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


@dataclass(frozen=True)
class Timing:
    """Samples of one call [s a unit of work], in the order they were taken."""

    samples: tuple[float, ...]

    def row(self) -> dict[str, float]:
        """Return the shortest and the middle sample, in nanoseconds."""
        middle = statistics.median(self.samples)
        return {"best_ns": rounded(min(self.samples) * 1e9), "median_ns": rounded(middle * 1e9)}


class Timed:
    """Something to time.

    Args:
        call: what is timed.
        units: how many units of work (steps, simulated seconds) one call does.
        before: what is done before every call, untimed.
        least: shortest time that a sample is taken over [s].
    """

    def __init__(
        self,
        call: Callable[[], Any],
        units: float,
        before: Callable[[], Any],
        least: float = 0.002,
    ) -> None:
        self._call = call
        self._units = units
        self._before = before
        self._least = least
        self._calls = 1

    def prepare(self) -> None:
        """Warm up, and find how many calls fill a sample."""
        self._elapsed(1)
        elapsed = self._elapsed(1)
        self._calls = max(1, min(1000, round(self._least / max(elapsed, 1e-9))))

    def sample(self) -> float:
        """Return seconds a unit of work, over one sample."""
        return self._elapsed(self._calls) / (self._calls * self._units)

    def _elapsed(self, calls: int) -> float:
        total = 0.0
        for _ in range(calls):
            self._before()
            start = time.perf_counter()
            self._call()
            total += time.perf_counter() - start
        return total


def compare(cases: Mapping[Key, Timed], rounds: int) -> dict[Key, Timing]:
    """Return timings of cases measured in turn, A B C A B C ...: drifts of the machine meet all alike."""
    for case in cases.values():
        case.prepare()
    samples: dict[Key, list[float]] = {key: [] for key in cases}
    with no_garbage_collection():
        for _ in range(rounds):
            for key, case in cases.items():
                samples[key].append(case.sample())
    return {key: Timing(tuple(taken)) for key, taken in samples.items()}


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
