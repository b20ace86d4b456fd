"""A manoeuvre's figures for the terminal, and its series as a file."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table
from rich.text import Text

from dq_marine.manoeuvres.quantities import Quantity, Result
from dq_marine.manoeuvres.series import Series
from dq_marine.util.files import with_folder, write_csv
from dq_marine.util.readable import readable

SHIP = 20.0
"""Length from which the limits for ships are shown as a yardstick [m]."""

IMO = "IMO: the most that Resolution MSC.137(76) allows ships of 100 m and more."


def result_table(result: Result) -> Table:
    """Return all figures: what, how much, in which unit; and the IMO's limit beside those that have one."""
    quantities = result.quantities()
    limited = result.length >= SHIP and any(quantity.limit is not None for quantity in quantities)
    table = Table(title=Text(f"{result.vehicle}: {result.manoeuvre}"), caption=Text(IMO) if limited else None)
    table.add_column("quantity", no_wrap=True)
    table.add_column("value", justify="right", style="bold", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    if limited:
        table.add_column("IMO", justify="right", no_wrap=True)
    for quantity in quantities:
        cells = [Text(quantity.label), Text(shown(quantity.value)), Text(quantity.unit)]
        table.add_row(*cells, *([_limit(quantity)] if limited else []))
    return table


def shown(value: float | None) -> str:
    """Return a number for reading."""
    if value is None:
        return "not reached"
    return readable(0.0 if abs(value) < 1e-9 else value, 4)


def _limit(quantity: Quantity) -> Text:
    """Return the limit, in red where it is exceeded."""
    if quantity.limit is None:
        return Text("")
    exceeded = quantity.value is not None and quantity.value > quantity.limit
    return Text(shown(quantity.limit), style="red" if exceeded else "green")


def write_series(series: Series, path: Path) -> None:
    """Write the series as CSV, one sample a line, units in the header.

    Raises:
        InvalidInputError: it cannot be written.
    """
    columns = {name: column.tolist() for name, column in series.columns().items()}
    rows = zip(*columns.values(), strict=True)
    write_csv(with_folder(path), (dict(zip(columns, row, strict=True)) for row in rows))
