"""The whole way, in a real browser: the command, the page, a person's keys, the vehicle."""

from __future__ import annotations

import csv
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from viewer.devtools import CTRL, Page, open_page
from viewer.panels import CAMERA_PLACED

pytestmark = pytest.mark.browser

PATIENCE = 180.0
KEYS = ("KeyW", "KeyS", "KeyE", "KeyQ")
READY = "document.querySelectorAll('#panel-controls details').length > 1"

LABELS = "[...document.querySelectorAll('#panel-readings .row > label')].map((one) => one.textContent)"

GOAL_FROM_VEHICLE = """(() => {
  const at = (...path) => viewer.scene_tree.find(["world", ...path]).object;
  const vehicle = at("vehicle"), goal = at("goal", "ghost");
  return goal.position.clone().sub(vehicle.position).applyQuaternion(vehicle.quaternion.clone().invert());
})()"""


@contextmanager
def flight(*options: str) -> Iterator[tuple[subprocess.Popen[str], Page]]:
    """The command `dq-marine fly`, and its page."""
    command = [sys.executable, "-m", "dq_marine", "fly", *options]
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
        # A shell that starts the tests in the background has its children ignore Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    try:
        assert process.stderr is not None
        said = process.stderr.readline()
        address = re.search(r"http://\S+", said)
        assert address, said
        with open_page(address[0], ready=READY, width=1000, height=700) as page:
            yield process, page
    finally:
        process.kill()
        process.communicate()


def press(page: Page, kind: str, code: str) -> None:
    page.evaluate(f"document.dispatchEvent(new KeyboardEvent('{kind}', {{code: '{code}', bubbles: true}}))")


def reading(label: str) -> str:
    """A JavaScript expression for the number that stands beside a label; NaN where there is none yet."""
    rows = "[...document.querySelectorAll('#panel-readings .row')]"
    row = f"{rows}.find((one) => one.firstChild.textContent === '{label}')"
    return f"parseFloat({row}?.querySelector('output').textContent)"


def slide(page: Page, name: str, value: float) -> None:
    slider = f"document.getElementById('control-{name}')"
    page.evaluate(f"{slider}.value = {value}; {slider}.oninput()")


def test_a_person_reaches_a_goal_by_the_keys(tmp_path: Path) -> None:
    """Ahead or astern, to port or starboard, as a person would who looks where the goal is; then it is held there."""
    trajectory = tmp_path / "flight.csv"
    options = ["--teleop", "--set", "current=0", "--seconds", "600", "--trajectory", str(trajectory)]
    start = ["--set", "start_radius=0", "--set", "goal_position=[0,0,8]"]
    with flight(*options, *start, "--start-distance", "2") as (process, page):
        page.wait_until(f"{reading('position error')} > 1.5")
        slide(page, "power", 0.3)  # a busy machine shows late where the vehicle is
        deadline = time.monotonic() + PATIENCE
        while page.evaluate(reading("position error")) > 0.4:
            assert time.monotonic() < deadline
            north, east, _ = page.evaluate(f"{GOAL_FROM_VEHICLE}.toArray()")
            wanted = {"KeyW": north > 0.2, "KeyS": north < -0.2, "KeyE": east > 0.2, "KeyQ": east < -0.2}
            for code, down in wanted.items():
                press(page, "keydown" if down else "keyup", code)
        for code in KEYS:
            press(page, "keyup", code)
        page.wait_until(f"Math.abs({reading('u, surge')}) < 0.02 && {reading('position error')} < 0.8")
        page.evaluate("document.getElementById('control-quit').click()")
        out, _ = process.communicate(timeout=120)
        assert process.returncode == 0, out
    assert "position error, end" in out
    assert trajectory.stat().st_size > 1000


@pytest.mark.sweep  # tests/viewer/test_panel_page.py has the plain case
def test_sliders_move_the_water_and_the_goal_and_tune_the_controller(tmp_path: Path) -> None:
    with flight("--panel", "--agent", "zero", "--current", "0.1", "--seed", "3") as (process, page):
        slide(page, "speed", np.log(20.0))
        slide(page, "current_bearing", 0.0)
        slide(page, "current_speed", 1.0)
        page.wait_until(f"{reading('north')} > 5.0")
        arrow = "viewer.scene_tree.find(['world', 'current', '0']).object"
        assert page.evaluate(f"{arrow}.matrixWorld.elements.slice(0, 3).some((one) => Math.abs(one) > 0)")
        ghost = "viewer.scene_tree.find(['world', 'goal', 'ghost']).object"
        before = page.evaluate(f"{ghost}.position.x")
        slide(page, "goal-0", before + 2.0)
        page.wait_until(f"Math.abs({ghost}.position.x - {before + 2.0}) < 0.02")
        slide(page, "gain_position_bandwidth", np.log(10.0))
        page.wait_until(
            "document.getElementById('notice').textContent.includes('too long for the controller')"
        )
        gain = "Math.exp(Number(document.getElementById('control-gain_position_bandwidth').value))"
        page.wait_until(f"Math.abs({gain} - 2.0) < 0.01")  # as it was
        page.evaluate("document.getElementById('control-playing').click()")
        page.wait_until("!document.getElementById('control-playing').checked")
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=120)
    assert process.returncode == 0, out


def choose(page: Page, name: str, value: str) -> None:
    choice = f"document.getElementById('control-{name}')"
    page.wait_until(
        f"{choice}.value === '{value}' || [...{choice}.options].some((one) => one.value === '{value}')"
    )
    page.evaluate(f"{choice}.value = '{value}'; {choice}.onchange()")


@pytest.mark.sweep
def test_another_vehicle_task_and_weather_are_chosen_in_the_page() -> None:
    said = "document.getElementById('notice').textContent"
    title = "document.getElementById('title').textContent"
    new_episode = "document.getElementById('control-reset').click()"
    with flight("--panel", "--set", "current=0", "--seed", "3") as (process, page):
        assert "from the next episode on" in page.evaluate(
            "document.getElementById('panel-controls').textContent"
        )
        slide(page, "wind_speed", 12.0)
        page.evaluate(new_episode)
        page.wait_until(f"{said}.includes('is submerged, where there is no wind')")
        page.wait_until(f"{title} === 'BlueROV2 Heavy' && {reading('position error')} > 0")
        choose(page, "task", "PathFollowing")
        choose(page, "vehicle", "bluerov2")
        page.wait_until("document.getElementById('control-vehicle').value === 'bluerov2'")
        page.evaluate(new_episode)
        page.wait_until(f"{title} === 'BlueROV2' && {LABELS}.includes('cross track error')")
        page.wait_until(f"{said} === '' && {reading('u, surge')} > 0.2")
        assert "position error" not in page.evaluate(LABELS)
        page.evaluate("document.getElementById('control-quit').click()")
        out, _ = process.communicate(timeout=120)
        assert process.returncode == 0, out


LINE_SHOWN = "document.getElementById('pull-line').style.display === 'block'"
MIDDLE = """pointing.pixels_of(
  viewer.scene_tree.find(["world", "vehicle"]).object.getWorldPosition(viewer.camera.position.clone())
)"""


def take_hold(page: Page) -> tuple[float, float]:
    """Press with Ctrl on the vehicle until it is held; return where.

    A vehicle that turns has gaps that one can look through, and on a busy machine it has gone before the press comes.
    """
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        middle = page.evaluate(MIDDLE)
        if middle is None:  # the scene is not whole yet
            continue
        x, y = middle
        page.mouse("mousePressed", x, y, held=CTRL)
        for _ in range(20):
            if page.evaluate(LINE_SHOWN):
                return x, y
            time.sleep(0.1)
        page.mouse("mouseReleased", x, y, held=CTRL)
    raise AssertionError("the vehicle was never under the mouse")


@pytest.mark.sweep  # tests/viewer/test_pull.py has the plain case
def test_the_vehicle_is_pulled_by_the_mouse_until_it_is_let_go_or_the_page_is_closed(tmp_path: Path) -> None:
    """What was pulled, and when, is in the trajectory."""
    trajectory = tmp_path / "flight.csv"
    options = ["--panel", "--agent", "zero", "--set", "current=0", "--seed", "3", "--seconds", "600"]
    where = f"[{reading('north')}, {reading('east')}]"
    with flight(*options, "--trajectory", str(trajectory)) as (process, page):
        page.wait_until(f"{reading('position error')} > 0")
        page.wait_until(CAMERA_PLACED)
        x, y = take_hold(page)
        begun = np.array(page.evaluate(where))
        right = np.array(page.evaluate("[0, 2].map((axis) => viewer.camera.matrixWorld.elements[axis])"))
        page.mouse("mouseMoved", x + 300, y, held=CTRL)
        to_the_right = "+".join(
            f"{share} * ({reading(name)} - {start})"
            for share, name, start in zip(right, ("north", "east"), begun, strict=True)
        )
        page.wait_until(f"{to_the_right} > 0.3")  # it drifts at first, wherever it was going
        page.mouse("mouseReleased", x + 300, y, held=CTRL)
        page.wait_until("document.getElementById('pull-line').style.display === 'none'")
        time.sleep(1.0)
        x, y = take_hold(page)
        page.mouse("mouseMoved", x - 150, y, held=CTRL)
        time.sleep(1.0)
        page.close()
        time.sleep(2.0)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=120)
    assert process.returncode == 0, out
    assert "The vehicle was pulled by hand in" in out
    with trajectory.open() as file:
        pushed = np.array([float(row["pushed"]) for row in list(csv.DictReader(file))[:-1]])
    assert np.flatnonzero(np.diff(pushed)).size == 4  # taken, let go, taken, closed
    assert not pushed[-10:].any()
