"""The page is one file that shows every figure, its words come from the numbers, and it is the same each time."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import pytest
from report import synthetic

from dq_marine.report.command import write_report
from dq_marine.report.names import OWN, RIVALS
from dq_marine.report.plan import Plan, Rows
from dq_marine.report.registry import STUDIES
from dq_marine.report.showing.advice import advice
from dq_marine.report.showing.axes import rendered
from dq_marine.report.showing.page import Page, make_page
from dq_marine.report.showing.page_html import html_of
from dq_marine.report.showing.page_markdown import markdown_of

PLAN = Plan(quick=True, seed=3)


@pytest.fixture(scope="module")
def page() -> Page:
    return make_page(STUDIES, synthetic.results(), PLAN)


@pytest.fixture(scope="module")
def folder(page: Page, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report")
    write_report(page, synthetic.results(), out)
    return out


def names(page: Page) -> list[str]:
    """Names of all figures."""
    return [picture.name for chapter in page.chapters for picture in chapter.pictures]


def test_every_study_has_a_chapter_with_figures_tables_and_findings(page: Page) -> None:
    assert [chapter.study.name for chapter in page.chapters] == list(STUDIES)
    for chapter in page.chapters:
        assert chapter.pictures, chapter.study.name
        assert chapter.tables, chapter.study.name
        assert chapter.findings, chapter.study.name
    assert len(set(names(page))) == len(names(page))


def test_tables_have_a_cell_for_each_column(page: Page) -> None:
    for chapter in page.chapters:
        for table in chapter.tables:
            assert {len(line) for line in table.lines} == {len(table.header)}, table.title


def test_the_file_needs_nothing_from_outside(folder: Path) -> None:
    html = (folder / "index.html").read_text()
    assert not re.search(r'(src|href)="(?!#)', html)
    assert "@import" not in html
    assert "url(http" not in html
    assert "<script" not in html


def test_identifiers_are_unique_and_all_references_lead_somewhere(folder: Path) -> None:
    html = (folder / "index.html").read_text()
    found = re.findall(r'\bid="([^"]+)"', html)
    assert len(found) == len(set(found))
    references = set(re.findall(r'href="#([^"]+)"', html)) | set(re.findall(r"url\(#([^)]+)\)", html))
    assert references <= set(found)


def test_markdown_shows_every_figure_and_the_files_are_there(folder: Path, page: Page) -> None:
    text = (folder / "report.md").read_text()
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    assert [Path(path).stem for path in pictures] == names(page)
    for path in pictures:
        assert (folder / path).read_bytes().startswith(b"\x89PNG")
        assert (folder / path).with_suffix(".svg").read_text().startswith("<?xml")


def test_every_point_is_on_disk(folder: Path) -> None:
    record = json.loads((folder / "results.json").read_text())
    assert record["studies"] == json.loads(json.dumps(synthetic.results()))
    assert record["seed"] == 3
    assert {"machine", "versions", "checks", "circumstances"} <= set(record)
    for name, rows in synthetic.results().items():
        assert len((folder / "data" / f"{name}.csv").read_text().splitlines()) == 1 + len(rows)


def test_machine_versions_and_seed_are_on_the_page(page: Page) -> None:
    for text in (html_of(page), markdown_of(page)):
        for fact in ("numpy", "numba", "cores usable", "quick, seed 3"):
            assert fact in text


def test_what_was_not_measured_is_said() -> None:
    results = {"terms": synthetic.terms()}
    text = html_of(make_page(STUDIES, results, PLAN))
    assert "Not measured: Error against cost, A million steps" in text
    assert "What to choose when" not in text


def test_a_figure_is_the_same_each_time() -> None:
    drawing = STUDIES["terms"].drawings(synthetic.terms())[0]
    assert rendered(drawing) == rendered(drawing)


def choices(results: dict[str, Any]) -> dict[str, list[str]]:
    """What is advised, and why, by what is wanted."""
    table = advice(results)
    assert table is not None
    return {wanted: [take, because] for wanted, take, because in table.lines}


def quicker(methods: Collection[str], factor: float) -> Rows:
    """Rows in which some methods need their time times a factor."""
    return [
        row | ({"best_ns": factor * row["best_ns"]} if row["method"] in methods else {})
        if "best_ns" in row
        else row
        for row in synthetic.work_precision()
    ]


def test_advice_follows_the_numbers() -> None:
    """Who is faster is taken, whoever it is; who loses nothing is safe."""
    wanted = "motion without damping, attitude to 1e-6 rad"
    for name, title in (("rkmk4", "RKMK4 on SE(3)"), ("dqvi4", "DQVI, order 4")):
        assert choices({"work_precision": quicker([name], 1e-4)})[wanted][0] == title
    safe = choices({"extreme": synthetic.extreme()})["inputs that may be anything, and no garbage out"]
    assert safe[0] == "DQVI, order 2"
    assert safe[1].startswith("0 of 8")


def test_findings_follow_the_numbers() -> None:
    find = STUDIES["work_precision"].findings
    assert "less time in 4, and more in 0" in find(quicker(OWN, 1e-4))[0]
    assert "less time in 0, and more in 4" in find(quicker(OWN, 1e4))[0]
    assert any("ahead of RK4" in sentence for sentence in find(quicker(OWN, 1e-4)))
    assert not any("ahead of RK4" in sentence for sentence in find(quicker(OWN, 1e4)))


def test_the_fastest_baseline_is_held_against_this_package_whichever_it_is() -> None:
    find = STUDIES["work_precision"].findings
    for name in RIVALS:
        sentences = find(quicker([name], 1e-4))
        pairs = [sentence for sentence in sentences if "the fastest baseline reaches" in sentence]
        assert len(pairs) == 1
        assert "less time in 0, and more in 4" in pairs[0], name


@pytest.fixture(scope="module")
def shown(folder: Path) -> Iterator[Any]:
    from viewer.devtools import DEBUGGING_FLAGS, Page, _debugger_url
    from websockets.sync.client import connect

    from dq_marine.viewer.transport.browser import HeadlessBrowser

    browser = HeadlessBrowser((folder / "index.html").as_uri(), 1200, 900, extra_flags=DEBUGGING_FLAGS)
    try:
        with connect(_debugger_url(browser.profile), max_size=None) as connection:
            opened = Page(connection)
            opened.wait_until("document.readyState === 'complete' && document.querySelector('figure')")
            yield opened
    finally:
        browser.close()


@pytest.mark.browser
def test_a_browser_shows_every_figure(shown: Any, page: Page) -> None:
    found = shown.evaluate("[...document.querySelectorAll('figure')].map((figure) => figure.id)")
    assert found == [f"figure-{name}" for name in names(page)]
    sizes = shown.evaluate(
        "[...document.querySelectorAll('figure svg')].map((svg) => "
        "[svg.getBoundingClientRect().width, svg.getBoundingClientRect().height, svg.querySelectorAll('path').length])"
    )
    assert len(sizes) == len(found)
    for width, height, paths in sizes:
        assert width > 600
        assert 100 < height < 1200
        assert paths > 10


@pytest.mark.browser
def test_a_browser_fetches_nothing_and_nothing_sticks_out(shown: Any) -> None:
    assert shown.evaluate("performance.getEntriesByType('resource').map((entry) => entry.name)") == []
    assert shown.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


@pytest.mark.browser
def test_figures_have_words_for_those_who_cannot_see_them(shown: Any) -> None:
    labels = shown.evaluate(
        "[...document.querySelectorAll('svg')].map((svg) => svg.getAttribute('aria-label'))"
    )
    assert all(label and len(label) > 20 for label in labels)
