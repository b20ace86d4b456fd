"""The report as one HTML file that needs nothing from outside."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from dq_marine.report.presentation import Check, Table, by_verdict, tally
from dq_marine.report.showing.page import LEAD, TITLE, Chapter, Page, Picture

FOLDED = 4
"""Tables of a chapter that stand open; more are folded."""

STYLE = """
:root { color-scheme: light; --ink: #222; --soft: #5a5a5a; --line: #d8d8d8; --good: #00664c; --bad: #a33c00; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1.2rem 4rem; max-width: 68rem; color: var(--ink); background: #fff;
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0.5rem 0; }
h2 { font-size: 1.4rem; margin: 3rem 0 0.6rem; padding-top: 0.8rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.8rem 0 0.4rem; }
p, li { max-width: 50rem; }
nav ul { display: flex; flex-wrap: wrap; gap: 0.3rem 1.2rem; padding: 0; list-style: none; }
a { color: #0057a0; }
.soft, figcaption, .note { color: var(--soft); font-size: 0.9rem; }
figure { margin: 1.6rem 0; }
figure svg { width: 100%; height: auto; }
figcaption { max-width: 50rem; }
figcaption b { color: var(--ink); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; margin: 0.4rem 0; }
th, td { padding: 0.25rem 0.7rem; text-align: right; border-bottom: 1px solid var(--line); vertical-align: top; }
th { border-bottom: 2px solid #999; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
table.words td, table.words th { text-align: left; }
tbody tr:hover { background: #f4f7fa; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.1rem 1rem; font-size: 0.9rem; }
dt { color: var(--soft); } dd { margin: 0; }
code { font-size: 0.92em; background: #f2f2f2; padding: 0 0.25em; border-radius: 3px; }
summary { cursor: pointer; color: #0057a0; margin: 0.6rem 0; }
.passed { color: var(--good); } .failed { color: var(--bad); font-weight: 700; }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav { display: none; }
  h2 { break-before: page; }
  figure, tr { break-inside: avoid; }
  .wide { overflow: visible; }
  a { color: inherit; text-decoration: none; }
}
"""


def html_of(page: Page) -> str:
    """Return the file's text."""
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(TITLE)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{escape(TITLE)}</h1><p>{inline(LEAD)}</p>",
        facts(page.circumstances),
        contents(page),
        in_short(page),
        check_section(page.checks),
        *(chapter_of(chapter) for chapter in page.chapters),
        again(page),
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def inline(text: str) -> str:
    """Return a text with `code` and *emphasis* as HTML."""
    marked = re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text, quote=False))
    return re.sub(r"(?<![\w*])\*([^*\n]+)\*(?![\w*])", r"<em>\1</em>", marked)


def facts(circumstances: dict[str, str]) -> str:
    """Return when, where and with what it was measured."""
    items = "".join(f"<dt>{escape(name)}</dt><dd>{escape(text)}</dd>" for name, text in circumstances.items())
    return f"<dl>{items}</dl>"


def contents(page: Page) -> str:
    """Return links to the chapters."""
    links = [("in-short", "In short"), ("checks", "Checks against theory")]
    links += [(chapter.study.name, chapter.study.title) for chapter in page.chapters]
    items = "".join(f'<li><a href="#{name}">{escape(title)}</a></li>' for name, title in links)
    return f"<nav><ul>{items}</ul></nav>"


def in_short(page: Page) -> str:
    """Return what to choose when, and what each study found."""
    items = "".join(
        f'<li><a href="#{chapter.study.name}">{escape(chapter.study.title)}</a>: '
        f"{inline(chapter.findings[0])}</li>"
        for chapter in page.chapters
        if chapter.findings
    )
    advised = table_of(page.advice) if page.advice else ""
    absent = f'<p class="note">Not measured: {escape(", ".join(page.missing))}.</p>' if page.missing else ""
    return f'<section id="in-short"><h2>In short</h2>{advised}<ul>{items}</ul>{absent}</section>'


def check_section(checks: Sequence[Check]) -> str:
    """Return the checks, those that failed first."""
    if not checks:
        return ""
    failed = [check for check in checks if check.passed is False]
    words = f"{tally(checks)}." + ("" if failed else " None failed.")
    table = f'<div class="wide">{check_table(by_verdict(checks))}</div>'
    if not failed:
        table = f"<details><summary>All checks</summary>{table}</details>"
    return f'<section id="checks"><h2>Checks against theory</h2><p>{words} Wall time decides none.</p>{table}</section>'


def check_table(checks: Sequence[Check]) -> str:
    """Return checks as a table."""
    rows = "".join(
        f"<tr><td>{escape(check.name)}</td><td>{escape(check.measured)}</td><td>{escape(check.expected)}</td>"
        f'<td class="{check.verdict.lower()}">{check.verdict}</td></tr>'
        for check in checks
    )
    header = "<th>check</th><th>measured</th><th>theory</th><th></th>"
    return f'<table class="words checks"><thead><tr>{header}</tr></thead><tbody>{rows}</tbody></table>'


def chapter_of(chapter: Chapter) -> str:
    """Return a study's part."""
    tables = [table_of(table) for table in chapter.tables]
    shown, folded = "".join(tables[:FOLDED]), "".join(tables[FOLDED:])
    if folded:
        folded = f"<details><summary>{len(tables) - FOLDED} more tables</summary>{folded}</details>"
    findings = "".join(f"<li>{inline(text)}</li>" for text in chapter.findings)
    return (
        f'<section id="{chapter.study.name}"><h2>{escape(chapter.study.title)}</h2>'
        f'<p class="soft">{inline(chapter.study.method)}</p><ul>{findings}</ul>'
        f"{''.join(picture_of(picture) for picture in chapter.pictures)}{shown}{folded}</section>"
    )


def picture_of(picture: Picture) -> str:
    """Return a figure, named for those who cannot see it."""
    label = escape(f"{picture.title}. {picture.caption}", quote=True)
    svg = picture.svg.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
    return (
        f'<figure id="figure-{picture.name}">{svg}'
        f"<figcaption><b>{escape(picture.title)}.</b> {inline(picture.caption)}</figcaption></figure>"
    )


def table_of(table: Table) -> str:
    """Return a table under its title."""
    header = "".join(f"<th>{escape(text)}</th>" for text in table.header)
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in line) + "</tr>" for line in table.lines
    )
    note = f'<p class="note">{inline(table.note)}</p>' if table.note else ""
    return (
        f'<h3>{escape(table.title)}</h3><div class="wide"><table class="{"words" if table.words else "numbers"}">'
        f"<thead><tr>{header}</tr></thead><tbody>{rows}</tbody></table></div>{note}"
    )


def again(page: Page) -> str:
    """Return how to measure this again."""
    options = (" --quick" if page.plan.quick else "") + (
        f" --seed {page.plan.seed}" if page.plan.seed else ""
    )
    return (
        f"<section><h2>Again</h2><p><code>dq-marine report{options} --fresh</code>. Every point is in "
        "<code>data/</code> as CSV and in <code>results.json</code>. Errors are the same in every run on one machine; "
        "times are not.</p></section>"
    )
