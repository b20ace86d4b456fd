"""The channel from pages to the process that draws: small words from its own pages, and nothing else from anybody."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from viewer.samples import ROV, snapshot
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import LEFT, Button, Event, Group, Slider
from dq_marine.viewer.live import Reading
from dq_marine.viewer.transport.panel_socket import LARGEST_WORD, MOST_KEPT

CONTROLS = (Group("all", (Button("go", "Go"), Slider("speed", "speed", 0.0, 2.0, 1.0, 0.1))),)
PATIENCE = 20.0


def shown() -> Iterator[LiveViewer]:
    with LiveViewer(ROV, title="An ROV") as running:
        running.draw(snapshot())
        running.show_controls(CONTROLS)
        yield running


viewer = pytest.fixture(shown)
lasting = pytest.fixture(shown, scope="module", name="lasting")
"""One that goes on, whatever it was told before."""


def panel_of(viewer: LiveViewer, **keywords: Any) -> ClientConnection:
    return connect(viewer.url.replace("http://", "ws://") + "panel", **keywords)


def told(page: ClientConnection, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """The first thing that a page is told and that is wanted."""
    while True:
        content: dict[str, Any] = json.loads(page.recv(timeout=PATIENCE))
        if wanted(content):
            return content


def events_of(viewer: LiveViewer, count: int) -> list[Event]:
    """So many events, once they have come."""
    events: list[Event] = []
    deadline = time.monotonic() + PATIENCE
    while len(events) < count and time.monotonic() < deadline:
        events += viewer.events()
        time.sleep(0.01)
    return events


def say(page: ClientConnection, name: str, value: Any = None) -> None:
    page.send(json.dumps({"name": name, "value": value}))


def test_words_come_in_their_order_and_once(viewer: LiveViewer) -> None:
    with panel_of(viewer) as page:
        say(page, "go")
        say(page, "speed", 1.5)
        assert events_of(viewer, 2) == [Event("go"), Event("speed", 1.5)]
        assert viewer.events() == []
    assert events_of(viewer, 1) == [Event(LEFT)]


def test_late_pages_are_told_what_there_is(viewer: LiveViewer) -> None:
    viewer.show_readings(2.5, {"Motion": (Reading("depth", 3.0, "m"),)})
    viewer.show_notice("a notice")
    with panel_of(viewer) as page, panel_of(viewer) as other:
        for one in (page, other):
            seen = {}
            while set(seen) != {"title", "controls", "readings", "notice"}:
                content = json.loads(one.recv(timeout=PATIENCE))
                seen[content["path"]] = content
            assert seen["title"]["text"] == "An ROV"
            assert seen["notice"]["text"] == "a notice"
            assert seen["readings"]["groups"] == {"Motion": [["depth", 3.0, "m"]]}
            assert [one["name"] for one in seen["controls"]["groups"][0]["controls"]] == ["go", "speed"]
        viewer.show_values({"speed": 2.0})
        for one in (page, other):
            assert told(one, lambda content: content["path"] == "values")["values"] == {"speed": 2.0}


@pytest.mark.parametrize(
    "message",
    [
        "no JSON",
        b"\x00\xff",
        "[" * 1000,
        "[]",
        "{}",
        '{"name": "go"}',
        '{"name": 3, "value": null}',
        '{"name": "go", "value": {}}',
        '{"name": "go", "value": NaN}',
        '{"name": "go", "value": [1, "a"]}',
        json.dumps({"name": "stick", "value": [0.0] * 17}),
        '{"name": "go", "value": null, "more": 1}',
        json.dumps({"name": "go", "value": "x" * LARGEST_WORD}),
    ],
    ids=lambda message: str(message)[:24],
)
def test_a_page_that_says_anything_else_is_cut_off(message: str | bytes, lasting: LiveViewer) -> None:
    with panel_of(lasting) as page:
        page.send(message)
        with pytest.raises(ConnectionClosed):
            told(page, lambda content: False)
    assert events_of(lasting, 1) == [Event(LEFT)]


def test_words_that_nobody_takes_are_forgotten_oldest_first(viewer: LiveViewer) -> None:
    with panel_of(viewer) as page:
        for _ in range(MOST_KEPT + 50):
            say(page, "go")
        say(page, "speed", 0.5)
        assert page.ping().wait(PATIENCE)  # answered after all that was said before
        events = viewer.events()
    assert len(events) == MOST_KEPT
    assert events[-1] == Event("speed", 0.5)


def test_who_does_not_know_the_path_is_refused(lasting: LiveViewer) -> None:
    address = lasting.url.replace("http://", "ws://")
    guessed = address.rstrip("/").rpartition("/")[0] + "/AAAAAAAAAAAAAAAAAAAAAA/panel"
    with pytest.raises(InvalidStatus):
        connect(guessed)


@pytest.mark.parametrize("origin", ["http://example.org", "http://127.0.0.1:1", "null"])
def test_a_page_of_another_origin_is_refused(origin: str, lasting: LiveViewer) -> None:
    with pytest.raises(InvalidStatus):
        panel_of(lasting, origin=origin)
    assert lasting.events() == []


def test_a_page_under_another_name_is_refused(lasting: LiveViewer) -> None:
    """A name that was made to mean this computer does not get through."""
    with pytest.raises(InvalidStatus):
        panel_of(lasting, additional_headers={"Host": "evil.example"})
