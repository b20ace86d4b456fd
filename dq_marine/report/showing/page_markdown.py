"""The report as Markdown, with its figures as files beside it."""

from __future__ import annotations

from collections.abc import Sequence

from dq_marine.report.presentation import Check, Table, by_verdict, tally
from dq_marine.report.showing.page import LEAD, TITLE, Chapter, Page
from dq_marine.util.markdown_table import markdown_table

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
    lines = [
        [
            check.name,
            check.measured,
            check.expected,
            "**FAILED**" if check.passed is False else check.verdict,
        ]
        for check in by_verdict(checks)
    ]
    return f"## Checks against theory\n\n{tally(checks)}. Wall time decides none.\n\n" + markdown_table(
        ["check", "measured", "theory", ""], lines, words=True
    )


def table_of(table: Table) -> str:
    """Return a table under its title."""
    note = f"\n\n{table.note}" if table.note else ""
    return f"### {table.title}\n\n{markdown_table(table.header, table.lines, words=table.words)}{note}"
