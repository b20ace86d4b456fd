"""How much is measured, and who is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from dq_marine.report.timing import Key, Timed, Timing, compare

T = TypeVar("T")

LEAST = 0.02
"""Shortest time that a sample is taken over [s]."""


class NotInstalledError(Exception):
    """A section needs what is not there; the message says how to get it."""


@dataclass(frozen=True)
class Plan:
    """The settings of a run.

    Attributes:
        quick: small sizes and few samples.
        threads: numbers of threads to measure with, ascending: 1, and all that may be used.
        scratch: folder for what a long section keeps, so that it can go on after a kill.
        tell: says what is being measured just now.
        progress: says what part of it is done, from 0 to 1.
    """

    quick: bool
    threads: tuple[int, ...]
    scratch: Path
    tell: Callable[[str], None]
    progress: Callable[[float], None]

    @property
    def rounds(self) -> int:
        """Samples of each case."""
        return 5 if self.quick else 9

    def compare(self, cases: Mapping[Key, Timed]) -> dict[Key, Timing]:
        """Return timings of cases measured in turn, telling what part is done."""
        return compare(cases, self.rounds, least=LEAST, progress=self.progress)

    def pick(self, full: T, quick: T) -> T:
        """Return the one that is wanted."""
        return quick if self.quick else full


@dataclass(frozen=True)
class Section:
    """A part of the page.

    Attributes:
        name: for `--only`.
        title: on the page.
        method: what is measured and how, in Markdown.
        measure: does it; raises `NotInstalledError` where something is missing.
        tables: of the measured content, in Markdown.
        headline: of the measured content, one line for the terminal.
    """

    name: str
    title: str
    method: str
    measure: Callable[[Plan], dict[str, Any]]
    tables: Callable[[dict[str, Any]], str]
    headline: Callable[[dict[str, Any]], str]
