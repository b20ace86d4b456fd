"""A table in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def markdown_table(header: Sequence[str], lines: Iterable[Sequence[str]], *, words: bool = False) -> str:
    """Return a table: a column of words, then numbers, or words alone. A bar in a cell does not end it."""
    rule = ["---", *["---" if words else "---:"] * (len(header) - 1)]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in [header, rule, *lines]
    )
