"""A thing is pulled by the point under the mouse, in a real browser: what the page says, shows and lets go."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.devtools import ALT, CTRL, Page, element, open_page
from viewer.panels import CAMERA_PLACED, live_panel, panel_page
from viewer.samples import ROV, snapshot, yawed

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import LEFT, Event, Group, Pull

pytestmark = pytest.mark.browser

PATIENCE = 60.0
PLACE = np.array([3.0, -2.0, 5.0])
TURN = 0.7
GROUPS = (Group("Hand", (Pull("pull", "pull the vehicle", "/world/vehicle", 2.0, 1e6, key="KeyG"),)),)
LINE = "getComputedStyle(document.getElementById('pull-line')).display"

MIDDLE = """(() => {
  const place = viewer.scene_tree.find(["world", "vehicle"]).object.getWorldPosition(viewer.camera.position.clone());
  return pointing.pixels_of(place);
})()"""


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    with live_panel(GROUPS) as shown:
        shown.draw(snapshot(time=2.0, position_ned=PLACE, quaternion_body_to_ned=yawed(TURN)))
        yield shown


@pytest.fixture(scope="module")
def page(viewer: LiveViewer) -> Iterator[Page]:
    with panel_page(viewer, GROUPS) as shown:
        shown.wait_until(f"{element('clock')}.textContent === '2.0 s' && glide.at_rest() && {CAMERA_PLACED}")
        yield shown


@pytest.fixture
def middle(viewer: LiveViewer, page: Page) -> tuple[float, float]:
    """The pixel of the vehicle's origin; nothing was said before."""
    time.sleep(0.2)
    viewer.events()
    x, y = page.evaluate(MIDDLE)
    return x, y


def pulled(viewer: LiveViewer) -> Any:
    """The last value that is said, once something is and then for a while nothing more."""
    said: list[Event] = []
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        heard = [event for event in viewer.events() if event.name in ("pull", LEFT)]
        if said and not heard:
            return said[-1].value if said[-1].name == "pull" else LEFT
        said += heard
        time.sleep(0.2)
    raise AssertionError("nothing was said of a pull")


def camera(page: Page) -> Any:
    return page.evaluate("viewer.camera.position.toArray()")


@pytest.mark.parametrize("key", [CTRL, ALT])
def test_the_point_under_the_mouse_is_pulled_to_the_mouse(viewer, page, middle, key) -> None:
    """Both are under the mouse on the screen, at one distance along the camera's axis; the camera keeps still."""
    (x, y), stood = middle, camera(page)
    page.mouse("mousePressed", x, y, held=key)
    point, hand = pulled(viewer)
    assert np.all(np.abs(point) <= 0.51 * np.array([ROV.length, ROV.width, ROV.height]) + 0.02)
    rotation = np.array([[np.cos(TURN), -np.sin(TURN), 0], [np.sin(TURN), np.cos(TURN), 0], [0, 0, 1]])
    assert_allclose(hand, PLACE + rotation @ point, atol=1e-3)  # nothing is stretched yet
    assert page.evaluate(LINE) == "block"
    page.mouse("mouseMoved", x + 90, y - 40, held=key)
    again, moved = pulled(viewer)
    assert again == point
    on_screen = page.evaluate(f"""(() => {{
      const world = viewer.scene_tree.find(["world"]).object, place = viewer.camera.position.clone();
      return pointing.pixels_of(world.localToWorld(place.set(...{list(moved)})));
    }})()""")
    assert_allclose(on_screen, [x + 90, y - 40], atol=0.5)
    north, up, east = page.evaluate(
        "viewer.camera.getWorldDirection(viewer.camera.position.clone()).toArray()"
    )
    assert np.dot([north, east, -up], np.subtract(moved, hand)) == pytest.approx(0.0, abs=1e-3)
    ends = page.evaluate(
        "['x2', 'y2'].map((name) => Number(document.querySelector('#pull-line line').getAttribute(name)))"
    )
    assert_allclose(ends, [x + 90, y - 40], atol=1.0)
    page.mouse("mouseReleased", x + 90, y - 40, held=key)
    assert pulled(viewer) is None
    assert page.evaluate(LINE) == "none"
    assert camera(page) == pytest.approx(stood)


def test_plain_dragging_turns_the_camera_until_the_panel_says_otherwise(viewer, page, middle) -> None:
    (x, y), stood = middle, camera(page)
    page.mouse("mousePressed", x, y)
    page.mouse("mouseMoved", x + 30, y)
    page.mouse("mouseReleased", x + 30, y)
    page.wait_until(
        f"viewer.camera.position.distanceTo({{x: {stood[0]}, y: {stood[1]}, z: {stood[2]}}}) > 0.01"
    )
    assert not [event for event in viewer.events() if event.name == "pull"]
    toggle = "document.dispatchEvent(new KeyboardEvent('keydown', {code: 'KeyG', bubbles: true}))"
    page.evaluate(toggle)
    switch = element("control-pull")
    page.evaluate(f"{switch}.of_the_episode_before = true")
    viewer.show_controls(GROUPS)  # as at the next episode
    page.wait_until(f"!{switch}.of_the_episode_before && {switch}.checked")
    x, y = page.evaluate(MIDDLE)
    page.mouse("mousePressed", x, y)
    assert pulled(viewer) is not None
    page.mouse("mouseReleased", x, y)
    assert pulled(viewer) is None
    page.evaluate(toggle)


def test_beside_the_vehicle_nothing_is_taken(viewer, page, middle) -> None:
    x, y = middle
    page.mouse("mousePressed", x - 250, y + 200, held=CTRL)
    page.mouse("mouseReleased", x - 250, y + 200, held=CTRL)
    time.sleep(0.3)
    assert not [event for event in viewer.events() if event.name == "pull"]


@pytest.mark.parametrize("end", ["window.dispatchEvent(new Event('blur'))", None])
def test_who_looks_elsewhere_or_begins_another_episode_lets_go(viewer, page, middle, end) -> None:
    x, y = middle
    page.mouse("mousePressed", x, y, held=CTRL)
    assert pulled(viewer) is not None
    if end is None:
        viewer.show_controls(GROUPS)
    else:
        page.evaluate(end)
    assert pulled(viewer) is None
    page.mouse("mouseReleased", x, y, held=CTRL)


@pytest.mark.sweep
def test_a_page_that_is_loaded_again_or_closed_lets_go(viewer) -> None:
    with open_page(viewer.url, width=1000, height=700) as other:
        for close in (False, True):
            # Until its script has run, `panel` is the element of that name.
            other.wait_until("!window.old && panel.holds?.length === 1 && panel.connected()")
            other.wait_until("viewer.scene_tree.find(['world', 'vehicle']).object.children.length > 3")
            other.wait_until(f"glide.at_rest() && {CAMERA_PLACED}")
            time.sleep(0.3)
            x, y = other.evaluate(MIDDLE)
            viewer.events()
            other.mouse("mousePressed", x, y, held=CTRL)
            assert isinstance(pulled(viewer), tuple)
            if close:
                other.close()
            else:
                other.evaluate("window.old = true; setTimeout(() => location.reload())")
            assert pulled(viewer) in (None, LEFT)


def test_help_says_how(page) -> None:
    listed = page.evaluate(f"{element('panel-keys')}.textContent")
    assert "Ctrldragpull the vehicle by the point under the pointer" in listed
