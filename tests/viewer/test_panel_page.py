"""Every control of the panel, in a real browser: by mouse, keys and gamepad."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.devtools import Page, element, open_page
from viewer.panels import live_panel, panel_page
from viewer.samples import snapshot

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.controls import (
    Axis,
    Button,
    Choice,
    Group,
    Number,
    Place,
    Slider,
    Stick,
    Switch,
)
from dq_marine.viewer.live import Reading

pytestmark = pytest.mark.browser

PATIENCE = 60.0
GROUPS = (
    Group(
        "Flight",
        (
            Button("step", "Step", key="Period"),
            Switch("playing", "play", True, key="Space"),
            Choice("agent", "flown by", ("one", "two"), "one"),
            Slider("speed", "speed", 0.1, 20.0, 1.0, 0.1, "x", logarithmic=True),
            Number("seed", "seed", 0, 1000, 3),
        ),
        note="What this is about.",
    ),
    Group(
        "Helm",
        (
            Stick(
                "stick", "helm", (Axis("astern, ahead", "KeyS", "KeyW", (3, -1)), Axis("b", "KeyA", "KeyD"))
            ),
            Place(
                "place",
                "goal",
                ("north", "east", "depth"),
                (-3.0, -3.0, 2.0),
                (3.0, 3.0, 8.0),
                (0.0, 0.0, 5.0),
                0.01,
                thing="/world/goal/ghost",
            ),
        ),
    ),
)


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    with live_panel(GROUPS) as shown:
        yield shown


@pytest.fixture(scope="module")
def page(viewer: LiveViewer) -> Iterator[Page]:
    with panel_page(viewer, GROUPS) as shown:
        yield shown


@pytest.fixture(autouse=True)
def nothing_said_before(viewer: LiveViewer, page: Page) -> None:
    next_event(viewer, None)


def next_event(viewer: LiveViewer, name: str | None) -> Any:
    """The value of the next event of a control; with None all that is there is passed over."""
    deadline = time.monotonic() + (PATIENCE if name else 0.3)
    while time.monotonic() < deadline:
        for event in viewer.events():
            if event.name == name:
                return event.value
        time.sleep(0.01)
    assert name is None, f"{name} did not come"
    return None


def key(page: Page, kind: str, code: str, *, text: str = "") -> None:
    page.evaluate(
        f"document.dispatchEvent(new KeyboardEvent('{kind}', {{code: '{code}', key: '{text}', bubbles: true}}))"
    )


def test_the_page_has_a_name_and_no_control_of_meshcats_own(page: Page) -> None:
    page.wait_until(f"{element('title')}.textContent === 'An ROV'")
    assert page.evaluate("document.title") == "An ROV - dq-marine"
    hidden = (
        "[...document.querySelectorAll('.dg.main')].every((one) => getComputedStyle(one).display === 'none')"
    )
    assert page.evaluate(hidden)


def test_a_button_by_mouse_and_by_key(viewer: LiveViewer, page: Page) -> None:
    page.evaluate(f"{element('control-step')}.click()")
    assert next_event(viewer, "step") is None
    key(page, "keydown", "Period")
    assert next_event(viewer, "step") is None


def test_a_switch_by_mouse_and_by_key_shows_what_it_is(viewer: LiveViewer, page: Page) -> None:
    page.evaluate(f"{element('control-playing')}.click()")
    assert next_event(viewer, "playing") is False
    key(page, "keydown", "Space")
    assert next_event(viewer, "playing") is True
    viewer.show_values({"playing": False})
    page.wait_until(f"{element('control-playing')}.checked === false")
    viewer.show_values({"playing": True})
    page.wait_until(f"{element('control-playing')}.checked === true")


def test_a_choice(viewer: LiveViewer, page: Page) -> None:
    page.evaluate(f"{element('control-agent')}.value = 'two'; {element('control-agent')}.onchange()")
    assert next_event(viewer, "agent") == "two"


def test_a_slider_in_equal_ratios(viewer: LiveViewer, page: Page) -> None:
    slider = element("control-speed")
    assert page.evaluate(f"{slider}.nextSibling.textContent") == "1.0 x"
    middle = f"(Number({slider}.min) + Number({slider}.max)) / 2"
    page.evaluate(f"{slider}.value = {middle}; {slider}.oninput()")
    assert next_event(viewer, "speed") == pytest.approx((0.1 * 20.0) ** 0.5, abs=0.05)
    assert page.evaluate(f"{slider}.nextSibling.textContent") == "1.4 x"


def test_a_number(viewer: LiveViewer, page: Page) -> None:
    page.evaluate(f"{element('control-seed')}.value = 77; {element('control-seed')}.onchange()")
    assert next_event(viewer, "seed") == 77


def test_a_stick_by_keys_springs_back(viewer: LiveViewer, page: Page) -> None:
    key(page, "keydown", "KeyW")
    assert next_event(viewer, "stick") == (1.0, 0.0)
    key(page, "keydown", "KeyA")
    assert next_event(viewer, "stick") == (1.0, -1.0)
    key(page, "keyup", "KeyW")
    assert next_event(viewer, "stick") == (0.0, -1.0)
    page.evaluate("window.dispatchEvent(new Event('blur'))")  # keys that go up elsewhere are not heard
    assert next_event(viewer, "stick") == (0.0, 0.0)


def test_a_stick_by_mouse_springs_back(viewer: LiveViewer, page: Page) -> None:
    slider = element("control-stick-1")
    page.evaluate(f"{slider}.value = 0.5; {slider}.oninput()")
    assert next_event(viewer, "stick") == (0.0, 0.5)
    page.evaluate(f"{slider}.onchange()")
    assert next_event(viewer, "stick") == (0.0, 0.0)


def test_a_stick_by_gamepad(viewer: LiveViewer, page: Page) -> None:
    page.evaluate("window.pad = {connected: true, axes: [0, 0.05, 0, -0.75], buttons: []}")
    page.evaluate("navigator.getGamepads = () => [null, window.pad]")
    assert next_event(viewer, "stick") == (0.75, 0.0)
    page.evaluate("window.pad.axes = [0, 0, 0, 0.05]")  # within the dead zone
    assert next_event(viewer, "stick") == (0.0, 0.0)
    page.evaluate("navigator.getGamepads = () => []")


def test_a_place_by_its_sliders(viewer: LiveViewer, page: Page) -> None:
    slider = element("control-place-1")
    page.evaluate(f"{slider}.value = 1.234; {slider}.oninput()")
    assert next_event(viewer, "place") == pytest.approx((0.0, 1.23, 5.0))
    assert page.evaluate(f"{slider}.nextSibling.textContent") == "1.23 m"
    viewer.show_values({"place": [0.0, 0.5, 5.0]})
    page.wait_until(f"Math.abs(Number({slider}.value) - 0.5) < 1e-9")


GOAL_ON_SCREEN = """(() => {
  const goal = viewer.scene_tree.find(["world", "goal", "ghost"]).object;
  const at = goal.getWorldPosition(viewer.camera.position.clone()).project(viewer.camera);
  const {left, top, width, height} = document.getElementById("meshcat-pane").getBoundingClientRect();
  return [left + width * (1 + at.x) / 2, top + height * (1 - at.y) / 2];
})()"""


def pointer(page: Page, kind: str, x: float, y: float, *, shift: bool = False) -> None:
    options = f"{{clientX: {x}, clientY: {y}, shiftKey: {str(shift).lower()}, pointerId: 1, bubbles: true}}"
    page.evaluate(
        f"document.querySelector('#meshcat-pane canvas').dispatchEvent(new PointerEvent('{kind}', {options}))"
    )


def show_goal(viewer: LiveViewer, page: Page, time: float, place: tuple[float, float, float]) -> None:
    upright = {"goal_quaternion_body_to_ned": np.array([1.0, 0.0, 0.0, 0.0])}
    viewer.draw(snapshot(time=time, goal_position_ned=np.array(place), **upright))
    viewer.show_values({"place": list(place)})
    page.wait_until(f"{element('clock')}.textContent === '{time:.1f} s' && glide.at_rest()")


def test_a_goal_is_dragged_along_the_level_and_with_shift_up_and_down(viewer: LiveViewer, page: Page) -> None:
    """Where the pointer lets go is where the goal then is on the screen."""
    show_goal(viewer, page, 5.0, (0.5, 0.5, 5.0))
    x, y = page.evaluate(GOAL_ON_SCREEN)
    camera = page.evaluate("viewer.camera.position.toArray()")
    pointer(page, "pointerdown", x, y)
    pointer(page, "pointermove", x + 40, y + 15)
    pointer(page, "pointerup", x + 40, y + 15)
    north, east, down = next_event(viewer, "place")
    assert down == 5.0
    assert math.hypot(north - 0.5, east - 0.5) > 0.05
    show_goal(viewer, page, 6.0, (north, east, down))
    assert_allclose(page.evaluate(GOAL_ON_SCREEN), [x + 40, y + 15], atol=3.0)
    pointer(page, "pointerdown", x + 40, y + 15)
    pointer(page, "pointermove", x + 40, y - 30, shift=True)
    pointer(page, "pointerup", x + 40, y - 30)
    lifted = next_event(viewer, "place")
    assert lifted[:2] == pytest.approx((north, east))
    assert lifted[2] < down - 0.05
    show_goal(viewer, page, 7.0, lifted)
    assert page.evaluate(GOAL_ON_SCREEN)[1] == pytest.approx(y - 30, abs=3.0)
    assert page.evaluate("viewer.camera.position.toArray()") == pytest.approx(camera)
    pointer(page, "pointermove", x, y)  # let go, it stays
    time.sleep(0.3)
    assert not [event for event in viewer.events() if event.name == "place"]


def test_who_does_not_take_the_goal_turns_the_camera(viewer: LiveViewer, page: Page) -> None:
    show_goal(viewer, page, 8.0, (0.5, 0.5, 5.0))
    x, y = page.evaluate(GOAL_ON_SCREEN)
    pointer(page, "pointerdown", x + 100, y + 100)
    pointer(page, "pointermove", x + 150, y + 100)
    pointer(page, "pointerup", x + 150, y + 100)
    time.sleep(0.3)
    assert not [event for event in viewer.events() if event.name == "place"]


def test_keys_while_a_number_is_typed_are_only_typed(viewer: LiveViewer, page: Page) -> None:
    page.evaluate(
        f"{element('control-seed')}.dispatchEvent(new KeyboardEvent('keydown', {{code: 'KeyW', bubbles: true}}))"
    )
    time.sleep(0.3)
    assert not [event for event in viewer.events() if event.name == "stick"]


def test_help_lists_the_keys(page: Page) -> None:
    assert page.evaluate(f"{element('panel-help')}.hidden")
    key(page, "keydown", "Slash", text="?")
    assert not page.evaluate(f"{element('panel-help')}.hidden")
    listed = page.evaluate(f"{element('panel-keys')}.innerText")
    for explained in ("Step", "play", "astern, ahead", "next camera", "this list"):
        assert explained in listed
    page.evaluate(f"{element('panel-help-close')}.click()")
    assert page.evaluate(f"{element('panel-help')}.hidden")


def test_a_group_has_a_note_and_stays_folded(viewer: LiveViewer, page: Page) -> None:
    folded = "document.querySelector('#panel-controls details')"
    assert page.evaluate(f"{folded}.querySelector('.note').textContent") == "What this is about."
    page.evaluate(f"window.old = {folded}; {folded}.open = false")
    viewer.show_controls(GROUPS)
    page.wait_until(f"{folded} !== window.old")
    assert page.evaluate(f"{folded}.open") is False
    page.evaluate(f"{folded}.open = true")
    viewer.show_controls((*GROUPS, Group("Seldom", (Button("seldom", "Seldom"),), opened=False)))
    page.wait_until("document.querySelectorAll('#panel-controls details').length === 3")
    opened = "[...document.querySelectorAll('#panel-controls details')].map((one) => one.open)"
    assert page.evaluate(opened) == [True, True, False]
    viewer.show_controls(GROUPS)
    page.wait_until("document.querySelectorAll('#panel-controls details').length === 2")


def test_readings_and_their_history(viewer: LiveViewer, page: Page) -> None:
    for second in range(5):
        viewer.show_readings(float(second), {"Motion": (Reading("depth", 5.0 + second, "m"),)})
    row = "[...document.querySelectorAll('#panel-readings .row')].find((one) => one.innerText.includes('depth'))"
    page.wait_until(f"{row}.querySelector('output').textContent === '9.000 m'")
    page.evaluate(
        f"(() => {{ const c = {row}.querySelector('canvas'); c.onmousemove({{offsetX: 0.45 * c.clientWidth}}); }})()"
    )
    assert page.evaluate(f"{row}.querySelector('output').textContent") == "7.000 m at 2.0 s"
    inked = (
        f"(() => {{ const c = {row}.querySelector('canvas'); return [...c.getContext('2d')"
        ".getImageData(0, 0, c.width, c.height).data].some((one) => one > 0); })()"
    )
    assert page.evaluate(inked)


def test_the_history_of_an_angle_has_a_gap_where_it_goes_round(viewer: LiveViewer, page: Page) -> None:
    page.evaluate("""
      window.moves = [];
      const pen = CanvasRenderingContext2D.prototype, move = pen.moveTo;
      pen.moveTo = function (...place) { moves.push(this.canvas); return move.apply(this, place); };
    """)
    for second, angle in enumerate((170.0, -170.0, -150.0)):
        turns = (Reading("heading", angle, "deg"), Reading("offset", angle, "m"))
        viewer.show_readings(float(second), {"Turn": turns})
    row = "[...document.querySelectorAll('#panel-readings .row')].find((one) => one.innerText.includes('{}'))"
    page.wait_until(f"{row.format('offset')}?.querySelector('output').textContent === '-150.0 m'")
    for name, gap in (("heading", True), ("offset", False)):
        assert page.evaluate(f"moves.includes({row.format(name)}.querySelector('canvas'))") is gap


def test_a_notice(viewer: LiveViewer, page: Page) -> None:
    viewer.show_notice("The task is done.")
    page.wait_until(f"{element('notice')}.textContent === 'The task is done.'")
    viewer.show_notice("")
    page.wait_until(f"{element('notice')}.textContent === ''")


def test_readings_that_are_no_more_are_taken_away(viewer: LiveViewer, page: Page) -> None:
    labels = (
        "[...document.querySelectorAll('#panel-readings .row > label')].map((one) => one.textContent).join()"
    )
    viewer.show_readings(1.0, {"Motion": (Reading("depth", 5.0, "m"),)})
    page.wait_until(f"{labels} === 'depth'")
    viewer.show_readings(1.0, {"Motion": (Reading("height", 0.1, "m"), Reading("north", 0.0, "m"))})
    page.wait_until(f"{labels} === 'height,north'")


def test_on_a_telephone_the_scene_can_be_seen(viewer: LiveViewer) -> None:
    with open_page(viewer.url, width=390, height=800) as page:
        page.wait_until("document.querySelectorAll('#panel-controls details').length === 2")
        assert page.evaluate(f"{element('panel')}.hidden")
        page.evaluate(f"{element('panel-open')}.click()")
        box = json.loads(page.evaluate(f"JSON.stringify({element('panel')}.getBoundingClientRect())"))
        assert box["left"] >= 0.0
        assert box["right"] <= page.evaluate("innerWidth")
        assert box["height"] <= 0.56 * page.evaluate("innerHeight")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_two_pages_at_once_and_one_that_is_loaded_again(viewer: LiveViewer, page: Page) -> None:
    with open_page(viewer.url) as other:
        other.wait_until("document.querySelectorAll('#panel-controls details').length === 2")
        other.evaluate(f"{element('control-step')}.click()")
        assert next_event(viewer, "step") is None
        other.evaluate("window.old = true; setTimeout(() => location.reload())")
        other.wait_until(
            "!window.old && document.querySelectorAll('#panel-controls details').length === 2 && panel.connected()"
        )
        other.evaluate(f"{element('control-step')}.click()")
        assert next_event(viewer, "step") is None
    page.evaluate(f"{element('control-step')}.click()")
    assert next_event(viewer, "step") is None
