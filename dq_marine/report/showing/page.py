"""The report as it is shown, before it is HTML or Markdown: chapters of words, figures and tables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from dq_marine.report import machine
from dq_marine.report.plan import Plan, Rows, Study
from dq_marine.report.presentation import Check, Table
from dq_marine.report.showing.advice import advice
from dq_marine.report.showing.axes import rendered

TITLE = "How exact, how fast, how safe: DQVI and its baselines"
LEAD = """\
Measured by one command on one machine. Every number, every sentence with a number in it and every recommendation on
this page is made from the measured points, which lie beside it as CSV and JSON."""


@dataclass(frozen=True)
class Picture:
    """A figure, drawn.

    Attributes:
        name: of its files.
        title: of the figure.
        caption: how to read it.
        svg: to stand in a page.
        png: the same as pixels.
    """

    name: str
    title: str
    caption: str
    svg: str
    png: bytes


@dataclass(frozen=True)
class Chapter:
    """What a study came to."""

    study: Study
    findings: list[str]
    pictures: list[Picture]
    tables: list[Table]


@dataclass(frozen=True)
class Page:
    """The whole report.

    Attributes:
        plan: the settings of the run.
        circumstances: when, where and with what it was measured, in words.
        advice: what to choose when.
        checks: measured against theory.
        chapters: one a study.
        missing: titles of studies that were not measured.
    """

    plan: Plan
    circumstances: dict[str, str]
    advice: Table | None
    checks: list[Check]
    chapters: list[Chapter]
    missing: list[str]

    @property
    def failures(self) -> list[Check]:
        """The checks that failed."""
        return [check for check in self.checks if check.passed is False]


def checks_of(studies: dict[str, Study], results: dict[str, Rows]) -> list[Check]:
    """Return all checks of what was measured."""
    return [check for name, rows in results.items() for check in studies[name].checks(rows)]


def make_page(
    studies: dict[str, Study],
    results: dict[str, Rows],
    plan: Plan,
    tell: Callable[[str], None] = lambda _: None,
) -> Page:
    """Return the report of what was measured.

    Args:
        studies: all there are, by name.
        results: rows by study; a study without any is left out.
        plan: the settings of the run.
        tell: is told what is drawn just now.
    """
    chapters = []
    for name, rows in results.items():
        study = studies[name]
        pictures = []
        for drawing in study.drawings(rows):
            tell(f"drawing {drawing.title}")
            svg, png = rendered(drawing)
            pictures.append(Picture(drawing.name, drawing.title, drawing.caption, svg, png))
        chapters.append(Chapter(study, study.findings(rows), pictures, study.tables(rows)))
    return Page(
        plan,
        circumstances(plan),
        advice(results),
        checks_of(studies, results),
        chapters,
        [study.title for name, study in studies.items() if name not in results],
    )


def circumstances(plan: Plan) -> dict[str, str]:
    """Return when, where and with what it was measured."""
    here = machine.machine()
    versions = machine.versions()
    busy = machine.load()
    facts = {
        "made": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "processor": f"{here['cpu']}, {here['cores']} cores usable, {here['system']}",
        "versions": ", ".join(f"{name} {number}" for name, number in versions.items()),
        "commit": machine.commit("dq_marine", "envs"),
        "run": f"{'quick' if plan.quick else 'full'}, seed {plan.seed}",
        "load": "" if busy is None else f"{busy} processes wanted a core in the last minute",
    }
    return {name: text for name, text in facts.items() if text}


def record(page: Page, results: dict[str, Rows]) -> dict[str, Any]:
    """Return everything as JSON has it."""
    return {
        "quick": page.plan.quick,
        "seed": page.plan.seed,
        "circumstances": page.circumstances,
        "machine": machine.machine(),
        "versions": machine.versions(),
        "checks": [check.__dict__ for check in page.checks],
        "studies": results,
    }
