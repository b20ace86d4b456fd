"""Section: pictures a second of the viewer, drawn by the processor alone."""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import gymnasium as gym

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.agents import DPController
from dq_marine.envs.core.view import shape_of
from dq_marine.errors import MissingDependencyError
from dq_marine.report.plan import Row, distinct
from dq_marine.report.presentation import three_digits
from dq_marine.report.timing import rounded
from dq_marine.viewer import (
    LiveViewer,
    OffscreenViewer,
    RealTimePacer,
    Shape,
    Snapshot,
    find_chromium,
    make_replay,
)
from suite import circumstances
from suite.plan import NotInstalledError, Plan, Section
from suite.tables import found, table

TESTS = circumstances.ROOT / "tests"
"""Where a page in a browser is looked into."""

SIZES = ((640, 480), (1400, 900))
ID = "dq_marine/StationKeeping-v0"
PERIODS = 300
"""Of the flight that is shown: 30 s."""

PICTURES, QUICK_PICTURES = 20, 5
"""In a sample."""

SECONDS, QUICK_SECONDS = 5.0, 1.0
"""That a page is watched for a sample."""

SAMPLES, QUICK_SAMPLES = 3, 1
PICTURE, LIVE, REPLAY = '`render_mode="rgb_array"`', "live page", "replay"

METHOD = f"""\
A BlueROV2 Heavy on its way to its goal in a current, drawn by a Chromium without a window and without a graphics card
(WebGL by SwiftShader). {PICTURE}: pictures a second that come back as arrays, with the caption, one for each control
period; *first* is the time from nothing to the first of them, with the start of server and browser. The pages: pictures
a second that the page draws by itself, while it is told a snapshot ten times a second, or plays.
"""

COUNT = """(() => {
  window.drawn = 0;
  const render = viewer.render.bind(viewer);
  viewer.render = () => { window.drawn += 1; render(); };
})()"""


def measure(plan: Plan) -> dict[str, Any]:
    """Return rates of pictures and pages.

    Raises:
        NotInstalledError: there is no browser, or a library is missing.
    """
    _check_installed()
    shape, snapshots = flight()
    rows: list[Row] = []
    for done, size in enumerate(SIZES):
        for part, (what, samples_of) in enumerate(
            ((PICTURE, pictures), (LIVE, live_page), (REPLAY, replay_page))
        ):
            plan.tell(f"{what}, {size[0]} x {size[1]}")
            plan.progress((done + part / 3) / len(SIZES))
            rows.append(
                {"what": what, "width": size[0], "height": size[1]} | samples_of(plan, shape, snapshots, size)
            )
    return {"rows": rows}


def flight() -> tuple[Shape, list[Snapshot]]:
    """Return a vehicle and what it did."""
    env = gym.make(ID, current=0.3)
    inner: Any = env.unwrapped
    controller = DPController.for_env(env)
    observation, _ = env.reset(seed=1)
    controller.reset(env)
    snapshots = [inner.snapshot()]
    for _ in range(PERIODS):
        observation, *_ = inner.step(controller.act(observation))
        snapshots.append(inner.snapshot())
    return shape_of(inner.vehicle), snapshots


def pictures(plan: Plan, shape: Shape, snapshots: list[Snapshot], size: tuple[int, int]) -> Row:
    """Return the rate of pictures, and how long the first took."""
    first, rates = [], []
    for _ in range(plan.pick(SAMPLES, QUICK_SAMPLES)):
        began = time.perf_counter()
        with OffscreenViewer(shape, *size) as viewer:
            shown = iter(snapshots)
            viewer.render(next(shown))
            first.append(time.perf_counter() - began)
            count = plan.pick(PICTURES, QUICK_PICTURES)
            for _ in range(3):
                began = time.perf_counter()
                for _ in range(count):
                    viewer.render(next(shown))
                rates.append(count / (time.perf_counter() - began))
    return _row(rates) | {"first_s": rounded(min(first))}


def live_page(plan: Plan, shape: Shape, snapshots: list[Snapshot], size: tuple[int, int]) -> Row:
    """Return the rate of a live page that follows a flight in real time."""
    with LiveViewer(shape) as viewer:
        viewer.draw(snapshots[0])
        with _page(viewer.url, size) as page:
            page.evaluate(COUNT)
            return _row(
                [_followed(plan, page, viewer, snapshots) for _ in range(plan.pick(SAMPLES, QUICK_SAMPLES))]
            )


def replay_page(plan: Plan, shape: Shape, snapshots: list[Snapshot], size: tuple[int, int]) -> Row:
    """Return the rate of a replay that plays."""
    with tempfile.TemporaryDirectory(prefix="dq-marine-") as folder:
        path = Path(folder) / "replay.html"
        make_replay(snapshots, shape).save(path)
        with _page(path.as_uri(), size) as page:
            page.wait_until("viewer.animator.playing")
            page.evaluate(COUNT)
            return _row([_watched(plan, page) for _ in range(plan.pick(SAMPLES, QUICK_SAMPLES))])


def _followed(plan: Plan, page: Any, viewer: LiveViewer, snapshots: list[Snapshot]) -> float:
    """Return pictures a second that a live page draws while it is told of a flight."""
    pacer = RealTimePacer()
    drawn, began = page.evaluate("drawn"), time.perf_counter()
    for snapshot in snapshots[: 1 + round(plan.pick(SECONDS, QUICK_SECONDS) / snapshots[1].time)]:
        viewer.draw(snapshot)
        pacer.wait_until(snapshot.time)
    return _rate(page, drawn, began)


def _watched(plan: Plan, page: Any) -> float:
    """Return pictures a second that a page draws by itself."""
    drawn, began = page.evaluate("drawn"), time.perf_counter()
    time.sleep(plan.pick(SECONDS, QUICK_SECONDS))
    return _rate(page, drawn, began)


def _rate(page: Any, drawn: int, began: float) -> float:
    now = page.evaluate("drawn")
    return float((now - drawn) / (time.perf_counter() - began))


def _row(rates: list[float]) -> Row:
    return {
        "best_per_s": rounded(max(rates)),
        "median_per_s": rounded(statistics.median(rates)),
        "samples_per_s": [rounded(rate) for rate in rates],
    }


@contextmanager
def _page(url: str, size: tuple[int, int]) -> Iterator[Any]:
    """Show a page of a size in a browser, and look into it as the tests do."""
    from viewer.devtools import open_page

    with open_page(url, width=size[0], height=size[1]) as page:
        yield page


def _check_installed() -> None:
    sys.path.insert(0, str(TESTS))
    missing = [name for name in ("meshcat", "PIL", "websockets") if find_spec(name) is None]
    if missing:
        raise NotInstalledError(f'It needs {", ".join(missing)}: pip install "dq-marine[render,dev]".')
    try:
        find_chromium()
    except MissingDependencyError as error:
        raise NotInstalledError(f"{error}.") from error


def tables(content: dict[str, Any]) -> str:
    """Return pictures a second by size."""
    rows = content["rows"]
    sizes = [(row["width"], row["height"]) for row in rows if row["what"] == PICTURE]
    lines = [[what, *(rate(rows, what, size) for size in sizes)] for what in distinct(rows, "what")]
    lines.append(
        [
            "first picture [s]",
            *(three_digits(found(rows, what=PICTURE, width=w, height=h)["first_s"]) for w, h in sizes),
        ]
    )
    return table(["pictures a second, best (median)", *(f"{w} x {h}" for w, h in sizes)], lines)


def rate(rows: list[Row], what: str, size: tuple[int, int]) -> str:
    """Return pictures a second, best and median."""
    row = found(rows, what=what, width=size[0], height=size[1])
    return f"{three_digits(row['best_per_s'])} ({three_digits(row['median_per_s'])})"


def headline(content: dict[str, Any]) -> str:
    """Return the rates at the smaller size, and the first picture."""
    rows = content["rows"]
    row = found(rows, what=PICTURE)
    size = (row["width"], row["height"])
    shown = ", ".join(f"{what} {rate(rows, what, size)}" for what in distinct(rows, "what"))
    return (
        f"pictures a second at {size[0]} x {size[1]} without a graphics card: {shown}; the first picture after "
        f"{three_digits(row['first_s'])} s"
    )


SECTION = Section("viewer", "Viewer", METHOD, measure, tables, headline)
