"""The legend of a live page, in a real browser: its arrows are as long as those in the scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot

from dq_marine.viewer import LiveViewer, Snapshot
from dq_marine.viewer.snapshot import Thrust

pytestmark = pytest.mark.browser

SIZE = {"width": 640, "height": 560}


def thrusting(force: float, **changes: object) -> Snapshot:
    """An ROV with one thruster that pushes it to starboard."""
    thrust = Thrust(np.array([0.1, 0.0, 0.0]), np.array([0.0, force, 0.0]))
    return snapshot(thrusts=(thrust,), wrench_body=[0, force, 0, 0, 0, 0], **changes)


def row(page: Page, name: str) -> str | None:
    """The words of a row of the legend; None where it is hidden."""
    shown = f"document.getElementById('legend-{name}')"
    return None if page.evaluate(f"{shown}.hidden") else str(page.evaluate(f"{shown}.innerText"))


def wait_for(page: Page, name: str, words: str) -> None:
    """Return when a row of the legend has words."""
    page.wait_until(f"document.getElementById('legend-{name}').innerText.includes('{words}')")


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    with LiveViewer(replace(ROV, max_thrust=40.0)) as shown:
        shown.draw(thrusting(12.0, time=1.0))
        yield shown


@pytest.fixture(scope="module")
def page(viewer: LiveViewer) -> Iterator[Page]:
    with open_page(viewer.url, **SIZE) as shown:
        yield shown


def test_as_many_newtons_as_an_arrow_of_that_length_on_the_screen(viewer: LiveViewer, page: Page) -> None:
    """An arrow across the view, at the vehicle, is compared with the legend's, pixel by pixel."""
    viewer.draw(thrusting(12.0, time=2.0))
    wait_for(page, "thrust", "thrust of each actuator · net 12 N")
    told = str(row(page, "thrust"))
    newtons = float(told.split()[1])
    legend = page.evaluate("document.querySelector('#legend-thrust .arrow').getBoundingClientRect().width")
    on_screen = page.evaluate("""(() => {
      const {camera, scene, scene_tree} = viewer, height = viewer.renderer.domElement.clientHeight;
      scene.updateMatrixWorld(true);
      const vehicle = scene_tree.find(["world", "vehicle"]).object.getWorldPosition(camera.position.clone());
      const length = scene_tree.find(["world", "thrust", "0"]).object.scale.x;
      const across = vehicle.clone().setFromMatrixColumn(camera.matrixWorld, 1).multiplyScalar(0.5 * length);
      const [above, below] = [vehicle.clone().add(across), vehicle.clone().sub(across)];
      return 0.5 * height * (above.project(camera).y - below.project(camera).y);
    })()""")
    assert legend / newtons == pytest.approx(on_screen / 12.0, rel=0.05)


def test_without_actuators_it_is_of_the_net_thrust(viewer: LiveViewer, page: Page) -> None:
    viewer.draw(snapshot(time=3.0, wrench_body=[30.0, 40.0, 0, 0, 3.0, 4.0]))
    wait_for(page, "thrust", "net thrust · 50 N, 5 N m")
    viewer.draw(thrusting(1500.0, time=4.0))
    wait_for(page, "thrust", "net 1.5 kN")


def test_the_current_is_named_where_there_is_one(viewer: LiveViewer, page: Page) -> None:
    viewer.draw(snapshot(time=5.0))
    page.wait_until("document.getElementById('legend-current').hidden")
    assert row(page, "wind") is row(page, "waves") is None
    assert page.evaluate("document.getElementById('legend-rose').hidden")
    viewer.draw(snapshot(time=6.0, current_ned=[0.0, -0.25, 0.0]))
    wait_for(page, "current", "current · 0.25 m/s to 270°")
    assert not page.evaluate("document.getElementById('legend-rose').hidden")


def test_a_goal_is_named_where_there_is_one(viewer: LiveViewer, page: Page) -> None:
    words = "document.getElementById('legend').innerText"
    viewer.draw(snapshot(time=7.0))
    page.wait_until(f"!{words}.includes('goal')")
    viewer.draw(snapshot(time=8.0, goal_position_ned=[1.0, 0.0, 5.0]))
    page.wait_until(f"{words}.includes('goal')")
    assert all(name in page.evaluate(words) for name in ("bow", "track"))
