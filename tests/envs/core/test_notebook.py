"""What a notebook shows: an environment as a table and its live page, a replay without any server."""

from __future__ import annotations

import html
import re
import time
from pathlib import Path

import numpy as np
import pytest
from support.environments import StationKeepingEnv
from viewer.devtools import open_page
from viewer.samples import ROV, snapshot

from dq_marine.errors import InvalidInputError
from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import LEFT, Event
from dq_marine.viewer.framed import framed_address

FRAME = "document.querySelector('iframe')?.contentWindow"


def shown(tmp_path: Path, cell: str) -> str:
    """Write the output of a cell into a page; return its address."""
    page = tmp_path / "notebook.html"
    page.write_text(f"<!DOCTYPE html><body>{cell}</body>", encoding="utf-8")
    return page.as_uri()


def test_an_environment_is_a_table_and_starts_nothing() -> None:
    env = StationKeepingEnv(render_mode="human", current=0.0)
    table = env._repr_html_()
    cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", table)
    told = dict(zip(cells[::2], cells[1::2], strict=True))
    assert told["environment"] == "dq_marine/StationKeeping-v0"
    assert told["vehicle"] == "BlueROV2 Heavy"
    assert told["action"] == ", ".join(env.action_names)
    assert all(one.name in told["observation"] for one in env.observations)
    assert told["control period"] == "0.1 s in 4 steps"
    assert "iframe" not in table
    assert env.viewer_url is None


def test_the_live_page_stands_below_the_table_as_long_as_it_is_open() -> None:
    env = StationKeepingEnv(render_mode="human", current=0.0)
    env.reset(seed=0)
    assert env.viewer_url is not None
    assert env.viewer_url.startswith("http://127.0.0.1:")
    assert f'src="{env.viewer_url}"' in env._repr_html_()
    env.close()
    assert env.viewer_url is None
    assert "iframe" not in env._repr_html_()


def test_a_replay_is_the_page_that_is_saved(tmp_path: Path) -> None:
    env = StationKeepingEnv(record=True)
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.zeros(6))
    replay, path = env.replay(), tmp_path / "replay.html"
    env.save_html(path)
    assert replay.page == path.read_text(encoding="utf-8")
    framed = re.search(r'srcdoc="([^"]*)"', replay._repr_html_())
    assert framed is not None
    assert html.unescape(framed[1]) == replay.page
    assert len(repr(replay)) < 100
    replay.save(tmp_path / "again.html")
    assert (tmp_path / "again.html").read_text(encoding="utf-8") == replay.page


def test_what_was_not_recorded_is_not_shown(tmp_path: Path) -> None:
    env = StationKeepingEnv()
    env.reset(seed=0)
    with pytest.raises(InvalidInputError, match=r"record=True, then replay\(\)"):
        env.replay()
    with pytest.raises(InvalidInputError, match=r"record=True, then save_mp4\(\)"):
        env.save_mp4(tmp_path / "flight.mp4")


@pytest.mark.browser
def test_a_replay_plays_inside_a_page_and_asks_for_nothing(tmp_path: Path) -> None:
    env = StationKeepingEnv(record=True)
    env.reset(seed=0)
    for _ in range(30):
        env.step(np.ones(6))
    with open_page(
        shown(tmp_path, env.replay()._repr_html_()), ready=f"{FRAME}?.animator?.time > 0.2"
    ) as page:
        assert page.evaluate(f"{FRAME}.document.getElementById('title').textContent") == "BlueROV2 Heavy"
        assert page.evaluate(f"{FRAME}.performance.getEntriesByType('resource').length") == 0
        assert page.evaluate("document.querySelector('iframe').clientHeight") > 100


@pytest.mark.browser
def test_a_live_page_lives_inside_a_page_from_elsewhere(tmp_path: Path) -> None:
    with LiveViewer(ROV) as viewer:
        viewer.draw(snapshot())
        address = shown(tmp_path, framed_address(viewer.url))
        with open_page(address, ready="document.querySelector('iframe')") as page:
            for patience in (
                1.0,
                2.0,
                4.0,
                8.0,
                16.0,
                32.0,
            ):  # until it has connected, which a reload then ends
                time.sleep(patience)
                page.evaluate("{ const frame = document.querySelector('iframe'); frame.src = frame.src; }")
                time.sleep(0.5)
                if Event(LEFT) in viewer.events():
                    return
    pytest.fail("the live page never connected")
