"""A replay of a ship in wind, waves and current: the foam behind it, and the weather in the legend."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot

from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import Jonswap
from dq_marine.viewer import save_replay
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.world.wake import BANDS, STATIONS, draw_wake

SHIP = Shape(80.0, 18.0, 12.0, kind="ship", draft=6.0)
SEA = Sea(Jonswap(4.0, 14.0), direction=math.radians(30.0))
SPEED, CURRENT, STEP, REACH = 6.0, 1.0, 2.0, 7 * 80.0

FOAM = """(() => {
  viewer.render();
  const foam = viewer.scene_tree.find(["world", "wake"]).object.children[0];
  return {shown: foam.visible, points: Array.from(foam.geometry.attributes.position.array)};
})()"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """It heads north through water that goes east, and then stops: what the current leaves is nearly too slow."""
    path = tmp_path_factory.mktemp("replay") / "ship.html"
    times = STEP * np.arange(80)
    moments = [
        snapshot(
            time=time,
            position_ned=[SPEED * min(time, 100.0), 0.0, 0.0],
            current_ned=[0.0, CURRENT, 0.0],
            wind_ned=[-8.0, 0.0, 0.0],
            sea=SEA,
            wrench_body=[5e5, 0, 0, 0, 0, 0],
        )
        for time in times
    ]
    save_replay(path, moments, SHIP)
    with open_page(path.as_uri(), width=640, height=560) as shown:
        yield shown


def foam(page: Page, time: float) -> dict[str, Any]:
    """Whether foam is shown at a time of a replay, and its bands, shape (bands, stations, 2 edges, 3)."""
    page.evaluate(f"element('slider').oninput({{target: {{value: {time}}}}})")
    page.wait_until(f"trail.drawRange.count === {int(time / STEP) + 1}")
    drawn = page.evaluate(FOAM)
    return {"shown": drawn["shown"], "bands": np.reshape(drawn["points"], (BANDS, STATIONS, 2, 3))}


@pytest.mark.browser
def test_foam_lies_on_the_water_that_the_vessel_has_been_in(page: Page) -> None:
    assert not foam(page, 0.0)["shown"]
    drawn = foam(page, 100.0)
    assert drawn["shown"]
    middle = drawn["bands"].mean(axis=2)
    behind = SPEED * 100.0 - middle[0, :, 0]
    way = np.linspace(0.0, REACH, STATIONS)
    assert_allclose(behind * np.hypot(SPEED, CURRENT) / SPEED, way, atol=1.0)
    assert_allclose(middle[0, :, 1], CURRENT / SPEED * behind, atol=1.0)
    aside = np.linalg.norm(middle[1:, :, :2] - middle[:1, :, :2], axis=2)
    assert_allclose(aside, np.tile(0.4 * SHIP.width + 0.16 * way, (2, 1)), atol=0.5)
    near = drawn["bands"][:, :6].reshape(-1, 3)
    wanted = np.array([float(SEA.elevation(100.0, x, y)) for x, y, _ in near])
    assert_allclose(-near[:, 2], wanted + 0.002 * SHIP.length, atol=0.05)
    assert np.ptp(wanted) > 0.5


@pytest.mark.browser
def test_a_vessel_that_is_slow_makes_little_foam(page: Page) -> None:
    band = foam(page, 158.0)["bands"][0]
    widths = np.linalg.norm(band[:, 1] - band[:, 0], axis=1)
    assert widths[0] < 1.0 < 2.0 < widths.max(), "where it was fast there is foam"


@pytest.mark.browser
def test_the_legend_tells_the_weather(page: Page) -> None:
    told = {
        "wind": "wind 8.0 m/s from 000°",
        "waves": "waves from 210°, Hs 4 m, Tp 14 s",
        "current": "current · 1.00 m/s to 090°",
        "thrust": "net thrust · 500 kN, 0 N m",
    }
    for name, words in told.items():
        page.wait_until(f"document.getElementById('legend-{name}').innerText.includes('{words}')")
    bottom = page.evaluate("document.getElementById('legend').getBoundingClientRect().bottom")
    assert bottom < page.evaluate("document.getElementById('controls').getBoundingClientRect().top")


def test_a_vehicle_under_water_has_no_wake() -> None:
    assert draw_wake(ROV) == []
    (message,) = draw_wake(SHIP)
    triangles = message.content["object"]["geometries"][0]["data"]["index"]["array"]
    corners = np.frombuffer(triangles.data, dtype="<u4").reshape(-1, 3)
    assert len(corners) < 300, "few triangles"
    assert corners.max() == 2 * BANDS * STATIONS - 1
