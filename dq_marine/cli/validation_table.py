"""The table of a comparison for the terminal."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

from dq_marine.manoeuvres.table import shown
from dq_marine.validation import Comparison, Verdict

STYLES = {Verdict.AGREES: "green", Verdict.EXPLAINED: "yellow", Verdict.DIFFERS: "bold red"}


def comparison_table(comparison: Comparison) -> Table:
    """Return each number of each trial, what it should be, and the verdict; what explains a difference is below."""
    because = [
        f"{line.trial}, {line.quantity.label}: {line.expected.because}"
        for line in comparison.lines
        if line.verdict is Verdict.EXPLAINED
    ]
    table = Table(title=Text(comparison.title), caption=Text("\n".join(because)), caption_justify="left")
    table.add_column("trial")
    table.add_column("number")
    for heading in ("simulated", "reference"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    table.add_column("verdict")
    for line in comparison.lines:
        cells = (line.trial, line.quantity.label, shown(line.quantity.value), line.wanted, line.quantity.unit)
        table.add_row(*map(Text, cells), Text(line.verdict.value, style=STYLES[line.verdict]))
    return table
