"""Measures what is not measured yet, unit by unit, and shows how far it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rich.console import Console

from dq_marine.report.plan import Plan, Rows, Study, Unit
from dq_marine.report.screen import Screen
from dq_marine.report.store import Store


@dataclass(frozen=True)
class Task:
    """A unit of a study."""

    study: Study
    unit: Unit


class InterruptedRunError(Exception):
    """Ctrl-C was pressed; what had been measured is kept.

    Attributes:
        measured: number of units that are kept, of those wanted.
        wanted: number of units of the run.
    """

    def __init__(self, measured: int, wanted: int) -> None:
        super().__init__(f"{measured} of {wanted} units are measured")
        self.measured = measured
        self.wanted = wanted


def measure(studies: Iterable[Study], plan: Plan, store: Store, console: Console, *, fresh: bool) -> int:
    """Measure the units of some studies that the store lacks.

    Args:
        studies: to be measured.
        plan: the settings.
        store: keeps each unit as soon as it is measured.
        console: for the progress.
        fresh: whether to measure again what the store has.

    Returns:
        Number of units that are measured, now and before.

    Raises:
        InterruptedRunError: Ctrl-C was pressed.
    """
    wanted = [Task(study, unit) for study in studies for unit in study.units(plan)]
    if fresh:
        for task in wanted:
            store.forget(task.study, task.unit)
    missing = [task for task in wanted if store.rows(task.study, task.unit) is None]
    total, weighed = sum(task.unit.weight for task in missing), 0.0
    screen = Screen(console, estimate=True)
    with screen.section("report"):
        for done, task in enumerate(missing):
            screen.tell(f"{task.study.name}: {task.unit.name}", weighed / total)
            try:
                store.keep(task.study, task.unit, task.unit.run())
            except KeyboardInterrupt:
                raise InterruptedRunError(len(wanted) - len(missing) + done, len(wanted)) from None
            weighed += task.unit.weight
    return len(wanted)


def measured(studies: Iterable[Study], plan: Plan, store: Store) -> dict[str, Rows]:
    """Return the rows of all studies that have any in the store, by name, whichever run measured them."""
    found: dict[str, Rows] = {}
    for study in studies:
        groups: dict[str, list[Rows | None]] = {}
        for unit in study.units(plan):
            groups.setdefault(unit.group, []).append(store.rows(study, unit))
        rows = [row for kept in groups.values() for row in complete(kept)]
        if rows:
            found[study.name] = rows
    return found


def complete(kept: list[Rows | None]) -> Rows:
    """Return the rows of a group's units, none if one of them is missing."""
    rows: Rows = []
    for unit in kept:
        if unit is None:
            return []
        rows += unit
    return rows
