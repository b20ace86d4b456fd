"""Several replays in one page: each plays by itself, and all play, pause and start over together."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.sweeps import sweep
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot

from dq_marine.errors import InvalidInputError
from dq_marine.viewer import save_replay
from dq_marine.viewer.side_by_side import save_side_by_side

FRAMES = "[...document.querySelectorAll('iframe')].map((frame) => frame.contentWindow.animator)"
SECONDS = {"near & <slow>": 20, "far": 30}
"""What stands above each replay, and how long it is."""


@pytest.fixture(scope="module")
def together(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("replays")
    for number, seconds in enumerate(SECONDS.values()):
        moments = [snapshot(time=float(t), position_ned=[float(t), 0.0, 5.0]) for t in range(seconds + 1)]
        save_replay(folder / f"{number}.html", moments, ROV, title="one")
    page = folder / "index.html"
    save_side_by_side(
        page, {name: folder / f"{n}.html" for n, name in enumerate(SECONDS)}, title="Two & more"
    )
    return page


@pytest.fixture(scope="module")
def page(together: Path) -> Iterator[Page]:
    with open_page(together.as_uri(), ready=f"({FRAMES}).every(Boolean) && ({FRAMES}).length === 2") as shown:
        yield shown


def test_names_are_text_and_nothing_comes_from_outside(together: Path) -> None:
    text = together.read_text(encoding="utf-8")
    assert "<title>Two &amp; more</title>" in text
    assert "<h2>near &amp; &lt;slow&gt;</h2>" in text
    assert "<slow>" not in text


@pytest.mark.browser
@pytest.mark.parametrize("rows", sweep([[2], [3], [2, 2], [3, 2]], plain=[[2, 2]]), ids=str)
def test_at_most_three_are_in_a_row_and_rows_are_of_about_one_length(
    rows: list[int], together: Path, tmp_path: Path
) -> None:
    page, count = tmp_path / "many.html", sum(rows)
    save_side_by_side(page, {str(n): together.parent / "0.html" for n in range(count)})
    tops = (
        "[...document.querySelectorAll('section')].map((one) => Math.round(one.getBoundingClientRect().top))"
    )
    with open_page(page.as_uri(), ready=f"({tops}).length === {count}", width=1400, height=900) as shown:
        found = shown.evaluate(tops)
    assert [found.count(top) for top in sorted(set(found))] == rows


@pytest.mark.browser
def test_each_has_its_own_length(page: Page) -> None:
    assert page.evaluate(f"({FRAMES}).map((one) => one.duration)") == list(SECONDS.values())


@pytest.mark.browser
def test_all_pause_and_start_over_together(page: Page) -> None:
    page.wait_until(f"({FRAMES}).every((one) => one.playing && one.time > 0.3)")
    page.evaluate("document.getElementById('pause').click()")
    assert not page.evaluate(f"({FRAMES}).some((one) => one.playing)")
    # In one evaluation, so that no frame is drawn in between.
    began = page.evaluate(f"document.getElementById('restart').click(), ({FRAMES}).map((one) => one.time)")
    assert began == [0, 0]
    page.wait_until(f"({FRAMES}).every((one) => one.playing)")
    page.evaluate("document.getElementById('pause').click()")
    page.evaluate("document.getElementById('play').click()")
    page.wait_until(f"({FRAMES}).every((one) => one.playing)")


def test_what_cannot_be_put_together_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="is empty; give at least one"):
        save_side_by_side(tmp_path / "index.html", {})
    with pytest.raises(InvalidInputError, match=r"'lost', .*missing\.html, cannot be read"):
        save_side_by_side(tmp_path / "index.html", {"lost": tmp_path / "missing.html"})
    with pytest.raises(InvalidInputError, match="is a folder"):
        save_side_by_side(tmp_path, {"one": tmp_path / "one.html"})
    assert not (tmp_path / "index.html").exists()
