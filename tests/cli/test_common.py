"""What all commands share: what they show cannot act on the terminal."""

import io

import pytest
from rich.table import Table
from rich.text import Text

from dq_marine.cli.common import SafeConsole


@pytest.fixture
def console():
    return SafeConsole(file=io.StringIO(), width=80)


def test_names_from_outside_cannot_act_on_the_terminal(console):
    table = Table("name\x1b[2J")
    table.add_row("a\x9b31m\x07b")
    console.print("Wrote \x1b[31mred\x08\u202e\ud800", table)
    shown = console.file.getvalue()
    assert "Wrote ?[31mred???" in shown
    assert "name?[2J" in shown
    assert "a?31m?b" in shown


def test_texts_and_what_moves_are_no_way_round(console):
    moving = SafeConsole(file=io.StringIO(), force_terminal=True)
    with moving.status("flies \x1b]0;title\x07"):
        moving.print(Text("\x1b[2Jtext"))
    shown = moving.file.getvalue()
    assert "flies ?]0;title" in shown
    assert "?[2Jtext" in shown
    assert "\x1b[2J" not in shown


def test_lines_and_tabs_are_kept_and_markup_is_followed(console):
    console.print("one\ntwo [bold]three[/bold]\tfour", Text("five"))
    assert console.file.getvalue().splitlines() == ["one", "two three       four five"]
