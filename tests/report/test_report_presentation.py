"""Numbers, names and tables read as they should, on both pages."""

from __future__ import annotations

import pytest

from dq_marine.report.presentation import Check, Table, duration, factor, listed, number, power
from dq_marine.report.showing import page_html, page_markdown


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.01234, "0.012"),
        (12.34, "12"),
        (1234.5, "1,234"),
        (1.23e-7, "1.2e-7"),
        (-4e-5, "-4.0e-5"),
        (1e5, "1.0e5"),
        (float("inf"), "inf"),
    ],
)
def test_numbers(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(2.5e-8, "25.0 ns"), (3.14159e-6, "3.14 us"), (0.25, "250 ms"), (99.0, "99.0 s")],
)
def test_durations(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_factors_powers_and_lists() -> None:
    assert (factor(12.34), factor(0.5), factor(0.012)) == ("12.3x", "0.50x", "0.012x")
    assert (power(1e-2), power(1e-12)) == ("1e-2", "1e-12")
    assert listed([]) == ""
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert listed(["a, x", "b"]) == "a, x; and b"


def test_a_table_keeps_its_shape_whatever_its_cells_say() -> None:
    table = Table("A < B", ["method", "|x|"], [["a | b", "<1>"]], "*Note* with `code`.")
    html, markdown = page_html.table_of(table), page_markdown.table_of(table)
    assert "<td>a | b</td><td>&lt;1&gt;</td>" in html
    assert "A &lt; B" in html
    assert "<em>Note</em> with <code>code</code>." in html
    assert "| a \\| b | <1> |" in markdown
    assert "| --- | ---: |" in markdown


def test_failed_checks_come_first() -> None:
    checks = [Check("good", "1", "1", True), Check("bad", "2", "1", False)]
    for section in (page_html.check_section(checks), page_markdown.check_section(checks)):
        assert section.index("bad") < section.index("good")
        assert "1 of 2 checks passed" in section
        assert "FAILED" in section


def test_undecided_checks_count_neither_as_passed_nor_as_failed() -> None:
    checks = [Check("good", "1", "1", True), Check("open", "", "1", None), Check("bad", "2", "1", False)]
    for section in (page_html.check_section(checks), page_markdown.check_section(checks)):
        assert section.index("bad") < section.index("open") < section.index("good")
        assert "1 of 2 checks passed; too little was measured for 1 more." in section
    assert "undecided" in page_html.check_section(checks[:2])
    assert "None failed." in page_html.check_section(checks[:2])


def test_checks_that_all_passed_are_folded() -> None:
    assert "<details>" in page_html.check_section([Check("good", "1", "1", True)])
    assert page_html.check_section([]) == page_markdown.check_section([]) == ""
