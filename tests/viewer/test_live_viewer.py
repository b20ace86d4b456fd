"""The live page, in a real browser, shows what was drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from numpy.testing import assert_allclose
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot, yawed

from dq_marine.viewer import LiveViewer

pytestmark = pytest.mark.browser

CLOCK_TEXT = "document.getElementById('clock').textContent"


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    with LiveViewer(ROV) as shown:
        shown.draw(snapshot(time=1.0))
        yield shown


@pytest.fixture(scope="module")
def page(viewer: LiveViewer) -> Iterator[Page]:
    with open_page(viewer.url) as shown:
        shown.wait_until(f"{CLOCK_TEXT} === '1.0 s'")
        yield shown


def draw(viewer: LiveViewer, page: Page, time: float, **changes: object) -> None:
    """Draw a snapshot and wait until it has arrived in the page."""
    viewer.draw(snapshot(time=time, **changes))
    page.wait_until(f"{CLOCK_TEXT} === '{time:.1f} s' && glide.at_rest()")


@pytest.mark.parametrize(
    "path",
    [
        "/world/vehicle/frame",
        "/world/vehicle/floats",
        "/world/vehicle/heading_mark",
        "/world/vehicle/dome",
        "/world/vehicle/thrusters/0",
        "/world/goal/ghost",
        "/world/goal/ball",
        "/world/thrust/net",
        "/world/current/0",
        "/world/floor/sand",
        "/world/floor/grid",
        "/world/surface",
    ],
)
def test_everything_is_in_the_scene(page: Page, path: str) -> None:
    drawn = "children.map((child) => child.geometry ? child.geometry.attributes.position.count : 0)"
    assert page.node(path, drawn)[0] > 3
    assert page.node(path, "children[0].material.vertexColors") is True


def test_meshcat_scenery_is_hidden(page: Page) -> None:
    for path in ("/Grid", "/Axes", "/Lights/PointLightNegativeX"):
        assert page.node(path, "visible") is False


def test_the_sun_casts_no_shadow(page: Page) -> None:
    """It would on what is near the origin alone, and drawing it takes long."""
    assert page.node("/Lights/sun", "children[0].isDirectionalLight") is True
    assert page.node("/Lights/sun", "children[0].castShadow") is False


def test_what_cannot_be_seen_is_not_drawn(viewer: LiveViewer, page: Page) -> None:
    """Its node stays visible, which a person may switch off and on."""
    for time, force in ((1.1, 40.0), (1.2, 0.0), (1.3, 40.0)):
        draw(viewer, page, time, wrench_body=[force, 0, 0, 0, 0, 0])
        assert page.node("/world/thrust/net", "children[0].visible") is (force > 0.0)
        assert page.node("/world/thrust/net", "visible") is True
        assert page.node("/world/vehicle", "visible") is True


def pictures_apart(milliseconds: float, count: int) -> str:
    """Draw pictures by a clock that is set; return the share of the full resolution that they have at the end."""
    return (
        f"(() => {{ for (let i = 0; i < {count}; i++) {{ window.now += {milliseconds}; viewer.render(); }}"
        "return viewer.renderer.getPixelRatio(); })()"
    )


@pytest.mark.sweep
def test_slow_motion_gives_up_sharpness_until_it_stands_still(viewer: LiveViewer, page: Page) -> None:
    draw(viewer, page, 1.4)
    with open_page(viewer.url) as slow:
        slow.wait_until(f"{CLOCK_TEXT} === '1.4 s' && glide.at_rest()")
        slow.evaluate("(() => { window.now = 1e6; performance.now = () => window.now; })()")
        assert slow.evaluate(pictures_apart(20.0, 30)) == 1.0
        assert slow.evaluate(pictures_apart(100.0, 4)) == pytest.approx(0.7)
        assert slow.evaluate(pictures_apart(100.0, 30)) == 0.5
        assert slow.evaluate(pictures_apart(40.0, 30)) == 0.5
        assert slow.evaluate("(() => { window.now += 1000; })()") is None
        slow.wait_until("viewer.renderer.getPixelRatio() === 1")
        assert slow.evaluate(pictures_apart(40.0, 2)) == 0.5
        assert slow.evaluate(pictures_apart(10.0, 30)) == 1.0
        assert slow.evaluate(pictures_apart(1000.0, 30)) == 1.0, "pictures one by one are not motion"


def test_a_page_opened_late_shows_the_present_pose(viewer: LiveViewer, page: Page) -> None:
    draw(viewer, page, 2.0, position_ned=[1.0, -2.0, 6.0], quaternion_body_to_ned=yawed(0.5))
    with open_page(viewer.url) as late:
        late.wait_until(f"{CLOCK_TEXT} === '2.0 s' && glide.at_rest()")
        for shown in (page, late):
            w, *xyz = yawed(0.5)
            assert_allclose(shown.node("/world/vehicle", "position.toArray()"), [1.0, -2.0, 6.0])
            assert_allclose(shown.node("/world/vehicle", "quaternion.toArray()"), [*xyz, w], atol=1e-12)


def test_body_axes_in_the_page_after_all_transforms(viewer: LiveViewer, page: Page) -> None:
    draw(viewer, page, 3.0, position_ned=[4.0, 5.0, 6.0], quaternion_body_to_ned=yawed(math.pi / 2))
    page.evaluate("viewer.scene.updateMatrixWorld(true)")
    columns = page.node("/world/vehicle", "matrixWorld.elements.map((x) => x)")
    forward, starboard, down = columns[0:3], columns[4:7], columns[8:11]
    # three.js' world has x north, y up, z east once meshcat has turned its own frame.
    assert_allclose(forward, [0.0, 0.0, 1.0], atol=1e-12)
    assert_allclose(starboard, [-1.0, 0.0, 0.0], atol=1e-12)
    assert_allclose(down, [0.0, -1.0, 0.0], atol=1e-12)


def test_trail_grows_and_is_cleared_by_a_new_episode(viewer: LiveViewer, page: Page) -> None:
    count = "children[0].geometry.attributes.position.count"
    for step in range(5):
        draw(viewer, page, 4.0 + step, position_ned=[0.1 * step, 0.0, 5.0])
    before = page.node("/world/trail", count)
    draw(viewer, page, 9.0, position_ned=[0.5, 0.0, 5.0])
    assert page.node("/world/trail", count) == before + 1
    draw(viewer, page, 0.0)
    assert page.node("/world/trail", count) == 1
    draw(viewer, page, 0.5, position_ned=[0.5, 0.0, 5.0])
    assert page.node("/world/trail", count) == 2
    viewer.clear_trail()
    draw(viewer, page, 0.6, position_ned=[0.6, 0.0, 5.0])
    assert page.node("/world/trail", count) == 1


def test_the_vehicle_glides_to_where_it_is_told(viewer: LiveViewer, page: Page) -> None:
    """Halfway between two messages it is between them; a new episode jumps."""
    draw(viewer, page, 20.0, position_ned=[0.0, 0.0, 5.0])
    page.evaluate("""
      window.seen = [];
      (function watch() {
        seen.push(viewer.scene_tree.find(["world", "vehicle"]).object.position.x);
        if (seen.at(-1) !== 1) { requestAnimationFrame(watch); }
      })()
    """)
    draw(viewer, page, 20.1, position_ned=[1.0, 0.0, 5.0])
    page.wait_until("seen.at(-1) === 1")
    between = page.evaluate("seen.filter((x) => x > 0 && x < 1)")
    assert between
    assert between == sorted(between)
    viewer.draw(snapshot(time=0.0, position_ned=[0.0, 0.0, 5.0]))
    page.wait_until(f"{CLOCK_TEXT} === '0.0 s'")
    assert page.evaluate("glide.at_rest()")


def test_caption(viewer: LiveViewer, page: Page) -> None:
    draw(viewer, page, 12.3, position_ned=[0.0, 0.0, 7.25])
    page.wait_until("document.getElementById('details').textContent === 'depth 7.25 m · grid 0.5 m'")


def test_the_page_says_when_the_simulation_has_ended() -> None:
    with LiveViewer(ROV) as viewer:
        viewer.draw(snapshot(time=5.0))
        with open_page(viewer.url) as page:
            page.wait_until(f"{CLOCK_TEXT} === '5.0 s'")
            assert page.evaluate("document.getElementById('notice').textContent") == ""
            viewer.close()
            page.wait_until("document.getElementById('notice').textContent.includes('ended')")
            assert page.evaluate(CLOCK_TEXT) == "5.0 s"


def test_edges_are_smooth_where_a_graphics_card_draws_or_the_address_asks(
    viewer: LiveViewer, page: Page
) -> None:
    smoothed = "viewer.renderer.getContext().getContextAttributes().antialias"
    assert page.evaluate(smoothed) is False  # the processor draws here
    with open_page(f"{viewer.url}?smooth=1") as asked:
        assert asked.evaluate(smoothed) is True


def test_a_trail_that_grows_keeps_its_program(viewer: LiveViewer, page: Page) -> None:
    trail = "viewer.scene_tree.find(['world', 'trail', '<object>']).object"
    told = f"[{trail}.material.uuid, {trail}.geometry.attributes.position.count]"
    draw(viewer, page, 200.0, position_ned=[0.0, 0.0, 5.0])
    draw(viewer, page, 200.1, position_ned=[0.5, 0.0, 5.0])
    material, points = page.evaluate(told)
    draw(viewer, page, 200.2, position_ned=[1.0, 0.0, 5.0])
    assert page.evaluate(told) == [material, points + 1]
