"""What a study shows: drawings, tables and checks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Drawing:
    """A figure of the page.

    Attributes:
        name: good as a file name.
        title: of the figure.
        caption: how to read it.
        draw: returns the matplotlib figure.
    """

    name: str
    title: str
    caption: str
    draw: Callable[[], Any]


@dataclass(frozen=True)
class Table:
    """Rows of text; the first column is words, the others are numbers unless the table is one of words.

    Attributes:
        title: above it.
        header: one text a column.
        lines: one text a cell.
        note: below it.
        words: whether all columns are words.
    """

    title: str
    header: Sequence[str]
    lines: Sequence[Sequence[str]]
    note: str = ""
    words: bool = False


@dataclass(frozen=True)
class Check:
    """A measured number held against theory.

    Attributes:
        name: of what is checked.
        measured: what was found, in words and numbers.
        expected: what theory asks for.
        passed: whether they agree; None where too little was measured to tell.
    """

    name: str
    measured: str
    expected: str
    passed: bool | None

    @property
    def verdict(self) -> str:
        """What came of it, in a word or two."""
        if self.passed is None:
            return "undecided"
        return "passed" if self.passed else "FAILED"


def by_verdict(checks: Sequence[Check]) -> list[Check]:
    """Return the checks, those that failed first, those that are undecided next."""
    return sorted(checks, key=lambda check: (check.passed is not False, check.passed is not None))


def tally(checks: Sequence[Check]) -> str:
    """Return how many of those that could be decided passed, and how many could not."""
    decided = [check.passed for check in checks if check.passed is not None]
    undecided = len(checks) - len(decided)
    more = f"; too little was measured for {undecided} more" if undecided else ""
    return f"{sum(decided)} of {len(decided)} checks passed{more}"


def number(value: float, digits: int = 2) -> str:
    """Return a number for reading: 0.0123 as 0.012, 1.2e-7 with its exponent."""
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 1e4:
        return f"{value:.{digits}g}" if abs(value) < 100.0 else f"{value:,.0f}"
    return f"{value:.{digits - 1}e}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def power(value: float) -> str:
    """Return a power of ten: 1e-2."""
    return f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e")


def duration(seconds: float) -> str:
    """Return a time with a fitting unit."""
    for limit, factor, unit in ((1e-6, 1e9, "ns"), (1e-3, 1e6, "us"), (1.0, 1e3, "ms")):
        if seconds < limit:
            return f"{three_digits(seconds * factor)} {unit}"
    return f"{three_digits(seconds)} s"


def factor(value: float) -> str:
    """Return how many times one thing is another."""
    return f"{three_digits(value)}x" if value >= 0.095 else f"{value:.2g}x"


def three_digits(value: float) -> str:
    """Return a number to three digits, larger ones whole."""
    if abs(value) >= 99.95:
        return f"{value:,.0f}"
    return f"{value:.1f}" if abs(value) >= 9.995 else f"{value:.2f}"


def listed(names: Sequence[str]) -> str:
    """Return names as a text: a, b and c; with semicolons where a name has a comma itself."""
    if len(names) < 2:
        return "".join(names)
    comma = "; " if any("," in name for name in names) else ", "
    return f"{comma.join(names[:-1])}{comma[:1] if comma == '; ' else ''} and {names[-1]}"
