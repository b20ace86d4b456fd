"""A table of many columns loses no number on a narrow terminal, and is one table where there is room."""

import io

from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from dq_marine.util.parted_table import Column, PartedTable

AGENTS = Column("agent", ["controller", "zero"])
CELLS = st.lists(st.text("0123456789.", min_size=1, max_size=10), min_size=2, max_size=2)


def printed(table: PartedTable, width: int) -> list[str]:
    console = Console(file=io.StringIO(), width=width)
    console.print(table)
    return console.file.getvalue().splitlines()  # type: ignore[attr-defined,no-any-return]


@given(columns=st.lists(CELLS, max_size=12), width=st.integers(30, 150))
def test_every_number_is_there_whole_beside_its_agent(columns: list[list[str]], width: int) -> None:
    numbers = [Column(f"q{i} [m]", cells) for i, cells in enumerate(columns)]
    lines = printed(PartedTable([AGENTS], numbers), width)
    assert all(len(line) <= width for line in lines)
    for row, agent in enumerate(AGENTS.cells):
        told = [word for line in lines if line.startswith(agent) for word in line.split()[1:]]
        assert told == [cells[row] for cells in columns]
    headings = [word for line in lines for word in line.split() if word.startswith("q")]
    assert headings == [f"q{i}" for i in range(len(columns))]


def test_parts_are_as_few_as_fit_and_the_title_stands_above_the_first() -> None:
    numbers = [Column(f"quantity{i}", ["1.00", "2.00"]) for i in range(6)]
    table = PartedTable([AGENTS], numbers, title="title", caption="caption")
    for width, parts in ((80, 1), (60, 2), (32, 3), (20, 6)):
        lines = [line.strip() for line in printed(table, width) if line.strip()]
        assert sum(line.startswith("agent") for line in lines) == parts, width
        assert (lines[0], lines[-1]) == ("title", "caption")


def test_a_long_name_goes_on_below_before_the_table_is_parted() -> None:
    name = "of_the_second_try" * 3
    numbers = [Column("return", ["1.0"]), Column("success", ["100%"])]
    lines = printed(PartedTable([Column("agent", [name])], numbers), 40)
    assert sum("agent" in line for line in lines) == 1
    assert name in "".join(line.split()[0] for line in lines if line.strip())
