"""A table of many columns: a narrow terminal shows it in parts, one below another, so that no number is cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

NARROW = 12
"""Characters of a name that are left together; what is longer goes on below."""

UNBOUNDED = 100_000
"""Characters, more than any table is wide."""


@dataclass(frozen=True)
class Column:
    """A heading, which may take several lines, and a cell for each row, which may too."""

    heading: str
    cells: Sequence[str]
    style: str = ""


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
        """Yield the parts, as many as the console is narrow."""
        rest, first = list(self.numbers), True
        while rest or first:
            count = self._fitting(rest, console, options)
            part, rest = rest[:count], rest[count:]
            yield self._table(
                part, title=self.title if first else None, caption=None if rest else self.caption
            )
            if rest:
                yield ""
            first = False

    def _fitting(self, columns: Sequence[Column], console: Console, options: ConsoleOptions) -> int:
        """Return how many of the first columns fit beside the names; at least one, however narrow the console."""
        unbounded = options.update(width=UNBOUNDED)
        for count in range(len(columns), 1, -1):
            table = self._table(columns[:count], longest_name=NARROW)
            if Measurement.get(console, unbounded, table).maximum <= options.max_width:
                return count
        return 1

    def _table(
        self,
        part: Sequence[Column],
        *,
        longest_name: int | None = None,
        title: str | None = None,
        caption: str | None = None,
    ) -> Table:
        table = Table(title=title, caption=caption, box=SIMPLE_HEAD, show_edge=False, padding=0)
        for column in self.names:
            longest = max(
                len(line) for cell in (column.heading, *column.cells) for line in cell.splitlines() or [""]
            )
            table.add_column(
                Text(column.heading),
                style=column.style,
                overflow="fold",
                min_width=min(longest, NARROW),
                max_width=longest_name,
            )
        for column in part:
            # As text: [m] would be taken for markup.
            table.add_column(Text(column.heading), style=column.style, justify="right", no_wrap=True)
        columns = [*self.names, *part]
        for cells in zip(*(column.cells for column in columns), strict=True):
            table.add_row(*(Text(cell) for cell in cells), end_section=self.ruled)
        return table
