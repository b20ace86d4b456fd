"""`make docs` builds a site without a warning, whose links lead somewhere and which fetches nothing."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from viewer.devtools import open_page

ROOT = Path(__file__).parents[2]

pytestmark = [
    pytest.mark.sweep,
    pytest.mark.skipif(not find_spec("mkdocs"), reason="needs the extra `docs`"),
]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built as `make docs` builds it."""
    folder = tmp_path_factory.mktemp("site")
    settings = str(ROOT / "docs/site/mkdocs.yml")
    result = subprocess.run(
        [
            sys.executable,
            "-m",
            "mkdocs",
            "build",
            "--strict",
            "--config-file",
            settings,
            "--site-dir",
            str(folder),
        ],
        capture_output=True,
        text=True,
        cwd=folder,
        env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        timeout=1800,
    )
    assert result.returncode == 0, result.stderr
    assert "WARNING" not in result.stderr
    return folder


class Links(HTMLParser):
    """What a page leads to, what it loads, and the anchors that it has."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.led_to: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.anchors |= {value for value in (given.get("id"), given.get("name")) if value}
        if tag == "a" and given.get("href"):
            self.led_to.append(str(given["href"]))
        loads = tag in ("script", "img", "iframe", "source") or (
            tag == "link" and given.get("rel") in ("stylesheet", "icon", "preload")
        )
        target = given.get("src") or given.get("href")
        if loads and target:
            self.loaded.append(target)


def pages_of(site: Path) -> dict[Path, Links]:
    """The pages, without the replays, which tests/viewer looks at."""
    paths = [path for path in site.rglob("*.html") if not {"replays", "comparisons"} & set(path.parts)]
    return {path: Links(path.read_text(encoding="utf-8")) for path in paths}


def is_local(link: str) -> bool:
    return not urlsplit(link).scheme


def test_links_lead_to_files_and_anchors(site: Path) -> None:
    pages = pages_of(site)
    assert len(pages) > 40
    broken = []
    for path, links in pages.items():
        if path.name == "404.html":  # its links start at the root of a server
            continue
        for link in filter(is_local, [*links.led_to, *links.loaded]):
            parts = urlsplit(link)
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchor = unquote(parts.fragment)
            if not target.is_file() or (anchor and target in pages and anchor not in pages[target].anchors):
                broken.append(f"{path.relative_to(site)}: {link}")
    assert broken == []


def test_pages_load_nothing_from_a_network(site: Path) -> None:
    loaded = {link for links in pages_of(site).values() for link in links.loaded if not is_local(link)}
    assert loaded == set()
    styles = [path.read_text(encoding="utf-8") for path in site.rglob("*.css")]
    assert [link for style in styles for link in re.findall(r"url\(['\"]?(https?:[^)]+)", style)] == []


def test_replays_are_those_that_pages_show(site: Path) -> None:
    replays = {path.relative_to(site).as_posix() for path in (site / "replays").rglob("*.html")}
    assert len(replays) >= 6
    assert all((site / replay).stat().st_size > 100_000 for replay in replays)
    compared = list((site / "comparisons").rglob("*.html"))
    assert len(compared) >= 2
    assert all("const overlay = " in page.read_text(encoding="utf-8") for page in compared)


def test_pages_are_made_of_readme_and_notebook(site: Path) -> None:
    assert "MarineVecEnv" in (site / "simulator.html").read_text(encoding="utf-8")
    assert "env.unwrapped.replay" in re.sub(
        r"<[^>]+>", "", (site / "tutorials/first_steps.html").read_text(encoding="utf-8")
    )


@pytest.mark.browser
def test_search_answers_in_a_page_that_is_opened_as_a_file(site: Path) -> None:
    part = "document.querySelector('.md-search-result__{}')"
    index = f"{(site / 'index.html').as_uri()}?q=docking"
    with open_page(index, ready=part.format("meta")) as page:
        page.wait_until(f"{part.format('meta')}.textContent.includes('matching documents')")
        assert "tasks/Docking.html" in page.evaluate(f"{part.format('list')}.innerHTML")
