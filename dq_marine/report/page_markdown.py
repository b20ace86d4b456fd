"""The report as Markdown, with its figures as files beside it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dq_marine.report.page import LEAD, TITLE, Chapter, Page
from dq_marine.report.presentation import Check, Table

FIGURES = "figures"


def markdown_of(page: Page) -> str:
    """Return the file's text."""
    parts = [
        f"# {TITLE}",
        LEAD,
        "\n".join(f"- {name}: {text}" for name, text in page.circumstances.items()),
        "## In short",
        table_of(page.advice) if page.advice else "",
        "\n".join(
            f"- {chapter.study.title}: {chapter.findings[0]}" for chapter in page.chapters if chapter.findings
        ),
        f"Not measured: {', '.join(page.missing)}." if page.missing else "",
        check_section(page.checks),
        *(chapter_of(chapter) for chapter in page.chapters),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def chapter_of(chapter: Chapter) -> str:
    """Return a study's part."""
    pictures = [
        f"![{picture.title}]({FIGURES}/{picture.name}.png)\n\n**{picture.title}.** {picture.caption}"
        for picture in chapter.pictures
    ]
    parts = [
        f"## {chapter.study.title}",
        chapter.study.method,
        "\n".join(f"- {text}" for text in chapter.findings),
        *pictures,
        *(table_of(table) for table in chapter.tables),
    ]
    return "\n\n".join(part for part in parts if part)


def check_section(checks: Sequence[Check]) -> str:
    """Return the checks, those that failed first."""
    if not checks:
        return ""
    ordered = sorted(checks, key=lambda check: check.passed)
    lines = [
        [check.name, check.measured, check.expected, "passed" if check.passed else "**FAILED**"]
        for check in ordered
    ]
    passed = sum(check.passed for check in checks)
    return (
        f"## Checks against theory\n\n{passed} of {len(checks)} checks passed. Wall time decides none.\n\n"
        + grid(["check", "measured", "theory", ""], lines, words=True)
    )


def table_of(table: Table) -> str:
    """Return a table under its title."""
    note = f"\n\n{table.note}" if table.note else ""
    return f"### {table.title}\n\n{grid(table.header, table.lines, words=table.words)}{note}"


def grid(header: Sequence[str], lines: Iterable[Sequence[str]], *, words: bool = False) -> str:
    """Return a table; a bar in a cell does not end it."""
    rule = ["---", *["---" if words else "---:"] * (len(header) - 1)]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in [header, rule, *lines]
    )
