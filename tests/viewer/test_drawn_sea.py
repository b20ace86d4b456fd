"""The sea that is drawn is the sea that is simulated: where it is, when it is, and at the hull to the centimetre."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator
from support.sweeps import sweep
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot, yawed

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import Jonswap, PiersonMoskowitz
from dq_marine.viewer import LiveViewer, save_replay
from dq_marine.viewer.snapshot import Shape

BOAT = Shape(length=2.0, width=1.08, height=0.9, kind="catamaran", draft=0.2)
SHIP = Shape(length=80.0, width=18.0, height=12.0, kind="ship", draft=5.0)
SEAS = {
    "chop": (BOAT, Sea(Jonswap(0.3, 3.0), direction=0.7, seed=1)),
    "short-crested": (BOAT, Sea(Jonswap(1.0, 6.0), direction=-2.0, spreading=4.0, seed=2)),
    "storm": (SHIP, Sea(PiersonMoskowitz(15.0), direction=3.0, seed=3, depth=60.0)),
}


@pytest.fixture(scope="module", params=sweep(SEAS, plain=["storm"]))
def drawn(request: pytest.FixtureRequest) -> Iterator[tuple[LiveViewer, Page, Shape, Sea]]:
    shape, sea = SEAS[request.param]
    with LiveViewer(shape) as viewer:
        viewer.draw(snapshot(position_ned=[0.0, 0.0, 0.0], sea=sea))
        with open_page(viewer.url, ready="typeof glide === 'object'") as page:
            page.wait_until("document.getElementById('clock').textContent === '0.0 s'")
            page.node("/world/surface", "children[0].geometry.attributes.position.count")  # it is drawn
            yield viewer, page, shape, sea


def heights(page: Page, reach: float) -> RegularGridInterpolator:
    """The surface of the mesh around the vehicle: height at north and east of it [m]."""
    corners = page.evaluate(
        f"""(() => {{
          viewer.render();
          const places = viewer.scene_tree.find(["world", "surface"]).object.children[0].geometry.attributes.position;
          const near = [];
          for (let i = 0; i < places.count; i++) {{
            const [x, y, z] = [places.getX(i), places.getY(i), places.getZ(i)];
            if (Math.abs(x) < {reach} && Math.abs(y) < {reach}) {{ near.push([x, y, z]); }}
          }}
          return near;
        }})()"""
    )
    x, y, z = np.array(corners).T
    ticks = np.unique(x)
    assert np.array_equal(ticks, np.unique(y))
    return RegularGridInterpolator((ticks, ticks), -z.reshape(len(ticks), len(ticks)).T)


@pytest.mark.sweep  # a replay has the sea at its times in a plain run
@pytest.mark.browser
def test_at_the_hull_the_surface_is_the_simulated_one_to_a_centimetre(drawn) -> None:
    viewer, page, shape, sea = drawn
    half_length, half_width = 0.5 * shape.length, 0.5 * shape.width
    errors = []
    for index in range(20):
        time, course = 7.3 * index + 0.1, 0.4 * index
        place = np.array([3.0 * index, -5.0 * index, 0.3])
        viewer.draw(snapshot(time=time, position_ned=place, quaternion_body_to_ned=yawed(course), sea=sea))
        page.wait_until(f"document.getElementById('clock').textContent === '{time:.1f} s' && glide.at_rest()")
        surface = heights(page, 1.5 * shape.length)
        cos, sin = math.cos(course), math.sin(course)
        for ahead in np.linspace(-half_length, half_length, 9):
            for aside in (-half_width, 0.0, half_width):
                north, east = cos * ahead - sin * aside, sin * ahead + cos * aside
                wanted = sea.elevation(time, place[0] + north, place[1] + east)
                errors.append(float(surface((north, east)) - wanted))
    assert np.abs(errors).max() < 0.01
    assert sea.spectrum.significant_height > 0.25  # there is something to be wrong about


@pytest.mark.browser
def test_another_episode_begins_at_another_time_of_the_sea(drawn) -> None:
    viewer, page, _, sea = drawn
    for start in (1234.5, 0.0):
        viewer.clear_trail()
        viewer.draw(snapshot(time=0.5, position_ned=[0.0, 0.0, 0.0], sea=sea, sea_start=start))
        page.wait_until("document.getElementById('clock').textContent === '0.5 s' && glide.at_rest()")
        page.wait_until(
            f"""(() => {{
              viewer.render();
              const drawn = viewer.scene_tree.find(["world", "surface"]).object.children[0];
              const places = drawn.geometry.attributes.position;
              return Math.abs(-places.getZ((places.count - 1) / 2) - {float(sea.elevation(start + 0.5)):.6f}) < 1e-3;
            }})()"""
        )


@pytest.mark.sweep
@pytest.mark.browser
def test_a_replay_has_the_sea_at_its_times(tmp_path: Path) -> None:
    shape, sea = SEAS["short-crested"]
    moments = [snapshot(time=0.1 * t, position_ned=[0.02 * t, 0.0, 0.0], sea=sea) for t in range(101)]
    save_replay(tmp_path / "sea.html", moments, shape)
    with open_page((tmp_path / "sea.html").as_uri()) as page:
        for time in (0.0, 3.3, 9.9):
            page.evaluate(f"seek({time})")
            surface = heights(page, 1.5)
            assert float(surface((0.0, 0.0))) == pytest.approx(
                float(sea.elevation(time, 0.2 * time)), abs=5e-3
            )


@pytest.mark.browser
def test_a_calm_sea_is_flat_and_costs_nothing() -> None:
    with LiveViewer(ROV) as viewer:
        viewer.draw(snapshot())
        with open_page(viewer.url, ready="typeof glide === 'object'") as page:
            page.wait_until("document.getElementById('clock').textContent === '0.0 s'")
            assert page.node("/world/surface", "children[0].userData.waves === undefined")
            assert page.evaluate("viewer.render()") is None


def test_an_environment_shows_the_sea_that_moves_its_vehicle() -> None:
    """Under the vehicle's gravity, and at the time of the sea at which the episode began."""
    weather = [
        {"kind": "wind", "speed": 3.0, "direction_from": 0.0},
        {"kind": "sea", "spectrum": "jonswap", "height": 0.4, "period": 4.0},
    ]
    env = gym.make("dq_marine/WaypointTracking-v0", vehicle="otter", weather=weather).unwrapped
    env.reset(seed=3)
    shown = env.snapshot()
    assert shown.sea is not None
    assert shown.sea.gravity == env.vehicle.gravity
    assert shown.sea_start == env.episode.clock > 0.0
    assert shown.wind_ned == pytest.approx([-3.0, 0.0, 0.0])
    calm = gym.make("dq_marine/WaypointTracking-v0", vehicle="otter").unwrapped
    assert calm.sea is calm.wind_ned is None


def test_times_of_the_sea_are_numbers() -> None:
    with pytest.raises(InvalidInputError, match="sea_start is nan"):
        snapshot(sea_start=math.nan)
