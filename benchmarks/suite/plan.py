"""How much is measured, and who is told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")


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
