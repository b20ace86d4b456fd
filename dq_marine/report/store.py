"""What was measured, on disk: a file a unit, so that an interrupted run can go on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from dq_marine.report import machine
from dq_marine.report.files import write_json
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
            "sources": machine.source_fingerprint(),
            "machine": machine.machine(),
            "versions": machine.versions(),
        }

    def rows(self, study: Study, unit: Unit) -> Rows | None:
        """Return what was measured, None if it was not, or under other circumstances."""
        try:
            kept = json.loads(self._path(study, unit).read_text())
            fits = kept["stamp"] == _as_read(self._stamp(unit))
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return kept["rows"] if fits else None

    def keep(self, study: Study, unit: Unit, rows: Rows) -> Rows:
        """Write what was measured, and return it as it will be read."""
        content = {"stamp": self._stamp(unit), "rows": rows}
        write_json(self._path(study, unit), content, indent=None)
        kept: Rows = _as_read(rows)
        return kept

    def forget(self, study: Study, unit: Unit) -> None:
        """Remove what was measured."""
        self._path(study, unit).unlink(missing_ok=True)

    def _stamp(self, unit: Unit) -> dict[str, Any]:
        return {"settings": unit.settings, **self._circumstances}

    def _path(self, study: Study, unit: Unit) -> Path:
        return self.folder / study.name / f"{unit.name}.json"


def _as_read(content: Any) -> Any:
    """Return what reading would give for what is written: lists for tuples."""
    return json.loads(json.dumps(content))
