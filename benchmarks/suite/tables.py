"""Rows of numbers as Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from dq_marine.report.plan import Row
from dq_marine.report.presentation import three_digits
from dq_marine.util.markdown_table import markdown_table


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table whose first column is words and the others numbers, as a paragraph."""
    return markdown_table(header, rows) + "\n"


def find(rows: Iterable[Row], **wanted: Any) -> Row | None:
    """Return the first row with the given entries."""
    try:
        return found(rows, **wanted)
    except LookupError:
        return None


def found(rows: Iterable[Row], **wanted: Any) -> Row:
    """Return the first row with the given entries, which is there."""
    for row in rows:
        if all(row.get(key) == value for key, value in wanted.items()):
            return row
    raise LookupError(f"no row has {wanted}")


def millions(row: Row | None, which: str = "best_ns") -> str:
    """Return a row's rate in millions a second."""
    return "" if row is None else three_digits(1e3 / row[which])


def nanoseconds(row: Row | None, which: str = "best_ns") -> str:
    """Return a row's time."""
    return "" if row is None else three_digits(row[which])


def noise(rows: Iterable[Row]) -> str:
    """Return how far the medians of all rows are from the best, and whether they had a core for themselves."""
    rows = list(rows)
    excess = sorted(row["median_ns"] / row["best_ns"] - 1.0 for row in rows if "median_ns" in row)
    if not excess:
        return ""
    cores = [row["cores"] for row in rows if "cores" in row and row.get("threads", 1) == 1]
    least = f" A single thread had {min(cores):.0%} of a core or more." if cores else ""
    return (
        f"Noise: the median sample was {excess[len(excess) // 2]:.0%} slower than the best in the middle one of "
        f"{len(excess)} figures, {excess[-1]:.0%} in the worst.{least}\n"
    )
