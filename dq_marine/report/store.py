"""What was measured, on disk: a file a unit, so that an interrupted run can go on."""

from __future__ import annotations

from pathlib import Path

from dq_marine.report import machine, sources
from dq_marine.report.kept import Kept, as_read
from dq_marine.report.plan import Plan, Rows, Study, Unit


class Store:
    """The measured units of one kind of run: quick or full, with one seed.

    A unit counts as measured if the sources, the settings, the machine and the versions are those of now.

    Attributes:
        folder: where they are.
    """

    def __init__(self, out: Path, plan: Plan) -> None:
        self.folder = out / "measured" / f"{'quick' if plan.quick else 'full'}-seed{plan.seed}"
        self._circumstances = {
            "sources": sources.source_fingerprint(),
            "machine": machine.machine(),
            "versions": machine.versions(),
        }

    def rows(self, study: Study, unit: Unit) -> Rows | None:
        """Return what was measured, None if it was not, or under other circumstances."""
        rows: Rows | None = self._kept(study, unit).read()
        return rows

    def keep(self, study: Study, unit: Unit, rows: Rows) -> Rows:
        """Write what was measured, and return it as it will be read."""
        self._kept(study, unit).write(rows)
        kept: Rows = as_read(rows)
        return kept

    def forget(self, study: Study, unit: Unit) -> None:
        """Remove what was measured."""
        self._kept(study, unit).remove()

    def _kept(self, study: Study, unit: Unit) -> Kept:
        path = self.folder / study.name / f"{unit.name}.json"
        return Kept(path, {"settings": unit.settings, **self._circumstances})
