"""`dq-marine report`: measures what is missing, writes the page and what it is made of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table as ShownTable
from rich.text import Text

from dq_marine.errors import InvalidInputError
from dq_marine.report.cases import CASES
from dq_marine.report.plan import Plan, Rows
from dq_marine.report.presentation import tally
from dq_marine.report.registry import STUDIES
from dq_marine.report.runner import InterruptedRunError, measure, measured
from dq_marine.report.showing.page import Page, make_page, record
from dq_marine.report.showing.page_html import html_of
from dq_marine.report.showing.page_markdown import FIGURES, markdown_of
from dq_marine.report.store import Store
from dq_marine.util.files import with_folder, write_csv, write_json, write_whole


@dataclass(frozen=True)
class Request:
    """What was asked for.

    Attributes:
        out: folder of the report.
        only: names of the studies to measure; empty for all.
        plan: the settings.
        fresh: whether to measure again what is there.
    """

    out: Path
    only: tuple[str, ...]
    plan: Plan
    fresh: bool = False

    @property
    def command(self) -> str:
        """The command line that goes on with this."""
        parts = ["dq-marine report"]
        parts += ["--quick"] if self.plan.quick else []
        parts += [f"--only {name}" for name in self.only]
        parts += [f"--case {name}" for name in self.plan.cases]
        parts += [f"--seed {self.plan.seed}"] if self.plan.seed else []
        return " ".join([*parts, f"--out {self.out}"])


def checked(request: Request) -> Request:
    """Return the request if what it names exists.

    Raises:
        InvalidInputError: a study or a case is unknown.
    """
    for kind, given, known in (("study", request.only, STUDIES), ("case", request.plan.cases, CASES)):
        unknown = [name for name in given if name not in known]
        if unknown:
            raise InvalidInputError(f"{kind} {', '.join(unknown)} is unknown; give any of {', '.join(known)}")
    return request


def make_report(request: Request, console: Console) -> Page:
    """Measure, write, and show the gist.

    Raises:
        InvalidInputError: a study or case is unknown, or the folder cannot be written.
        InterruptedRunError: Ctrl-C was pressed.
    """
    wanted = [STUDIES[name] for name in checked(request).only] or list(STUDIES.values())
    store = Store(request.out, request.plan)
    count = measure(wanted, request.plan, store, console, fresh=request.fresh)
    results = measured(STUDIES.values(), Plan(request.plan.quick, request.plan.seed), store)
    try:
        with console.status("drawing") as status:
            page = make_page(STUDIES, results, request.plan, status.update)
            write_report(page, results, request.out)
    except KeyboardInterrupt:
        raise InterruptedRunError(count, count) from None
    show(page, request.out, console)
    return page


def write_report(page: Page, results: dict[str, Rows], out: Path) -> None:
    """Write the page as HTML and Markdown, its figures, and the points."""
    for chapter in page.chapters:
        for picture in chapter.pictures:
            write_whole(with_folder(out / FIGURES / f"{picture.name}.svg"), standalone(picture.svg))
            write_whole(with_folder(out / FIGURES / f"{picture.name}.png"), picture.png)
    for name, rows in results.items():
        write_csv(with_folder(out / "data" / f"{name}.csv"), rows)
    write_json(with_folder(out / "results.json"), record(page, results))
    write_whole(out / "report.md", markdown_of(page))
    write_whole(out / "index.html", html_of(page))


def standalone(svg: str) -> str:
    """Return an SVG as a file of its own."""
    return f'<?xml version="1.0" encoding="utf-8"?>\n{svg}'


def show(page: Page, out: Path, console: Console) -> None:
    """Print what was found, and where to read it."""
    table = ShownTable(show_header=False, box=None, padding=(0, 2, 1, 0))
    for chapter in page.chapters:
        table.add_row(
            Text(chapter.study.title, style="bold"), Text(chapter.findings[0] if chapter.findings else "")
        )
    console.print(table)
    console.print(tally(page.checks))
    for line in failure_lines(page):
        console.print(Text(line, style="bold red"), soft_wrap=True)
    console.print(f"Wrote {out / 'index.html'}, {out / 'report.md'}, {out / 'results.json'}", soft_wrap=True)


def failure_lines(page: Page) -> Iterable[str]:
    """Return a line a failed check."""
    return [
        f"FAILED {check.name}: {check.measured}, where theory asks for {check.expected}"
        for check in page.failures
    ]
