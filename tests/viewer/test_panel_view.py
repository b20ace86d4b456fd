"""What the panel has shown of the scene, in a real browser: cameras, things that can be hidden, another vehicle."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose
from viewer.devtools import Page, element
from viewer.panels import live_panel, panel_page
from viewer.samples import ROV, snapshot, yawed

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import Button, Group

pytestmark = pytest.mark.browser

PATIENCE = 60.0
LONGER = replace(ROV, length=3.0 * ROV.length)
GROUPS = (Group("Flight", (Button("step", "Step"),)),)


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    with live_panel(GROUPS) as shown:
        yield shown


@pytest.fixture(scope="module")
def page(viewer: LiveViewer) -> Iterator[Page]:
    with panel_page(viewer, GROUPS) as shown:
        yield shown


def choose_camera(page: Page, name: str) -> None:
    page.evaluate(f"{element('view-camera')}.value = '{name}'; {element('view-camera')}.onchange()")
    page.evaluate(
        "window.frames_seen = 0; (function count() { frames_seen++; requestAnimationFrame(count); })()"
    )
    page.wait_until("frames_seen > 3")


def camera_from_vehicle(page: Page) -> list[float]:
    """Where the camera is from the vehicle: north, up, east."""
    return page.evaluate(
        """(() => {
          viewer.scene.updateMatrixWorld(true);
          const at = (object) => object.matrixWorld.elements.slice(12, 15);
          const vehicle = at(viewer.scene_tree.find(["world", "vehicle"]).object);
          return at(viewer.camera).map((value, i) => value - vehicle[i]);
        })()"""
    )


def test_cameras_stand_where_they_say(viewer: LiveViewer, page: Page) -> None:
    viewer.draw(snapshot(time=2.0, quaternion_body_to_ned=yawed(0.0)))
    page.wait_until(f"{element('clock')}.textContent === '2.0 s' && glide.at_rest()")
    choose_camera(page, "chase")
    north, up, east = camera_from_vehicle(page)
    assert north < -1.0
    assert up > 0.3
    assert_allclose(east, 0.0, atol=1e-6)
    choose_camera(page, "side")
    north, up, east = camera_from_vehicle(page)
    assert east > 1.0
    assert_allclose(north, 0.0, atol=1e-6)
    choose_camera(page, "top")
    north, up, east = camera_from_vehicle(page)
    assert up > 1.5
    assert_allclose([north, east], 0.0, atol=1e-6)
    choose_camera(page, "onboard")
    north, up, east = camera_from_vehicle(page)
    assert 0.2 < north < 0.5
    choose_camera(page, "follow")


def test_a_free_camera_stays_where_it_is_in_the_world(viewer: LiveViewer, page: Page) -> None:
    viewer.draw(snapshot(time=3.0, position_ned=[0.0, 0.0, 5.0]))
    page.wait_until(f"{element('clock')}.textContent === '3.0 s' && glide.at_rest()")
    choose_camera(page, "free")
    before = camera_from_vehicle(page)
    viewer.draw(snapshot(time=4.0, position_ned=[4.0, -3.0, 6.0]))
    page.wait_until(f"{element('clock')}.textContent === '4.0 s' && glide.at_rest()")
    page.evaluate("frames_seen = 0")
    page.wait_until("frames_seen > 3")
    after = camera_from_vehicle(page)
    # The vehicle went 4 m north, 3 m west and 1 m down.
    assert_allclose([a - b for a, b in zip(after, before, strict=True)], [-4.0, 1.0, 3.0], atol=1e-6)
    choose_camera(page, "follow")


@pytest.mark.parametrize(
    ("name", "path"), [("forces", "/world/thrust"), ("goal", "/world/goal"), ("trail", "/world/trail")]
)
def test_things_can_be_hidden(name: str, path: str, page: Page) -> None:
    assert page.node(path, "visible") is True
    page.evaluate(f"{element(f'view-{name}')}.click()")
    assert page.node(path, "visible") is False
    page.evaluate(f"{element(f'view-{name}')}.click()")
    assert page.node(path, "visible") is True


def test_another_vehicle_is_drawn_in_place_of_the_first(viewer: LiveViewer, page: Page) -> None:
    length = """(() => {
      const box = [Infinity, -Infinity];
      viewer.scene_tree.find(["world", "vehicle"]).object.traverse((part) => {
        const places = part.geometry && part.geometry.attributes.position;
        for (let i = 0; places && i < places.count; i++) {
          box[0] = Math.min(box[0], places.getX(i));
          box[1] = Math.max(box[1], places.getX(i));
        }
      });
      return box[1] - box[0];
    })()"""
    before = page.evaluate(length)
    choose_camera(page, "top")
    _, near, _ = camera_from_vehicle(page)
    page.evaluate(f"{element('view-trail')}.click()")
    viewer.show_vehicle(LONGER, "A longer one")
    viewer.draw(snapshot(time=1.0))
    page.wait_until(f"{element('title')}.textContent === 'A longer one' && {length} > 2 * {before}")
    deadline = time.monotonic() + PATIENCE
    while not camera_from_vehicle(page)[1] > 2.0 * near:  # as many lengths away
        assert time.monotonic() < deadline
        time.sleep(0.05)
    assert page.node("/world/trail", "visible") is False  # as was asked for before
    page.evaluate(f"{element('view-trail')}.click()")
    choose_camera(page, "follow")
    assert page.evaluate("document.querySelectorAll('#panel-controls details').length") == 1
    viewer.show_vehicle(ROV, "An ROV")
    viewer.draw(snapshot(time=1.0))
    page.wait_until(f"{element('title')}.textContent === 'An ROV' && {length} < 1.1 * {before}")
