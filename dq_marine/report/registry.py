"""The studies of the report, in the order of the page. To add one, write its file and name it here."""

from __future__ import annotations

from dq_marine.report import extreme, long_run, solver, stability_map, terms, work_precision

STUDIES = {
    study.name: study
    for study in (
        work_precision.STUDY,
        long_run.STUDY,
        stability_map.STUDY,
        extreme.STUDY,
        terms.STUDY,
        solver.STUDY,
    )
}
"""The studies by name."""
