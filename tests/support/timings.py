"""Rows of the report less their wall times: what two runs on one machine must agree in."""

from __future__ import annotations

from dq_marine.report.plan import Rows

TIMING_FIELDS = ("best_ns", "median_ns", "seconds")
"""Endings of the entries that are wall time. All others are the same in every run on one machine."""


def without_timings(rows: Rows) -> Rows:
    """Return the rows less their wall times."""
    return [{key: value for key, value in row.items() if not key.endswith(TIMING_FIELDS)} for row in rows]
