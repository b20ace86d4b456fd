"""What a run of the report measures: studies, made of units that are measured and kept one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeAlias, TypeVar

from dq_marine.report.presentation import Check, Drawing, Table

T = TypeVar("T")

Row: TypeAlias = dict[str, Any]
Rows: TypeAlias = list[Row]


@dataclass(frozen=True)
class Plan:
    """The settings of a run.

    Attributes:
        quick: few sizes and samples.
        seed: of all that is drawn.
        cases: of the studies that have cases; empty for all.
    """

    quick: bool = False
    seed: int = 0
    cases: tuple[str, ...] = ()

    def pick(self, full: T, quick: T) -> T:
        """Return the one that is wanted."""
        return quick if self.quick else full

    def wants(self, case: str) -> bool:
        """Whether a case is to be measured."""
        return not self.cases or case in self.cases


@dataclass(frozen=True)
class Unit:
    """The smallest thing that is measured, kept and found again.

    Attributes:
        name: within its study; good as a file name.
        run: measures it.
        settings: what it depends on besides the sources: numbers, texts and lists.
        weight: how long it takes, roughly [s].
        group: rows of units with one group are shown if all of these units are there: some without others would
            compare what was measured with what was not.
    """

    name: str
    run: Callable[[], Rows]
    settings: dict[str, Any] = field(default_factory=dict)
    weight: float = 1.0
    group: str = ""


@dataclass(frozen=True)
class Study:
    """A part of the report. To add one, write a file with a `STUDY` and name it in `registry.STUDIES`.

    Attributes:
        name: for `--only`, and of its files.
        title: on the page.
        method: what is measured and how, a paragraph.
        units: what is to be measured.
        drawings: of the measured rows.
        tables: of the measured rows.
        findings: sentences with the measured numbers.
        checks: of the measured rows against theory; wall time never decides one.
    """

    name: str
    title: str
    method: str
    units: Callable[[Plan], list[Unit]]
    drawings: Callable[[Rows], list[Drawing]]
    tables: Callable[[Rows], list[Table]]
    findings: Callable[[Rows], list[str]]
    checks: Callable[[Rows], list[Check]] = lambda _: []


def find(rows: Rows, **wanted: Any) -> Rows:
    """Return the rows with the given entries."""
    return [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]


def distinct(rows: Rows, key: str) -> list[Any]:
    """Return the values of an entry, each once, in order of appearance."""
    return list(dict.fromkeys(row[key] for row in rows if key in row))
