"""A table of many columns: a narrow terminal shows it in parts, one below another, so that no number is cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

NARROW = 12
"""Characters of a name that are left together; what is longer goes on below."""


@dataclass(frozen=True)
class Column:
    """A heading, a word of it to a line, and a cell for each row, which may take several lines too."""

    heading: str
    cells: Sequence[str]
    style: str = ""

    @property
    def stacked(self) -> str:
        """The heading as it stands above the cells."""
        return self.heading.replace(" ", "\n")

    @property
    def width(self) -> int:
        """Characters of the longest line."""
        return max(
            (cell_len(line) for text in (self.stacked, *self.cells) for line in text.splitlines()), default=0
        )


@dataclass(frozen=True)
class PartedTable:
    """A table that Rich can print.

    Attributes:
        names: the columns that say what a row is. They stand in every part.
        numbers: the others, which go into as few parts as fit.
        title: above the first part.
        caption: below the last.
        ruled: whether there is a line between rows.
    """

    names: Sequence[Column]
    numbers: Sequence[Column]
    title: str | None = None
    caption: str | None = None
    ruled: bool = False

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the parts; a narrower console gets more of them."""
        *parts, last = self._parts(options.max_width)
        title = self.title
        for part in parts:
            yield self._table(part, title, None)
            yield ""
            title = None
        yield self._table(last, title, self.caption)

    def _parts(self, width: int) -> list[list[Column]]:
        """Return the columns of each part: as many as fit beside the names, one blank apart, and at least one."""
        room = width - sum(min(column.width, NARROW) + 1 for column in self.names) + 1
        parts: list[list[Column]] = [[]]
        for column in self.numbers:
            if parts[-1] and sum(one.width + 1 for one in [*parts[-1], column]) > room:
                parts.append([])
            parts[-1].append(column)
        return parts

    def _table(self, part: Sequence[Column], title: str | None, caption: str | None) -> Table:
        table = Table(title=title, caption=caption, box=SIMPLE_HEAD, show_edge=False, padding=0)
        for name in self.names:
            narrowest = min(name.width, NARROW)
            table.add_column(Text(name.stacked), style=name.style, overflow="fold", min_width=narrowest)
        for column in part:
            # As text: [m] would be taken for markup.
            table.add_column(Text(column.stacked), style=column.style, justify="right", no_wrap=True)
        for cells in zip(*(column.cells for column in (*self.names, *part)), strict=True):
            table.add_row(*map(Text, cells), end_section=self.ruled)
        return table
