"""Pictures have the right size, show the snapshot just drawn, and leave no process behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from viewer.processes import alive, group_members, wait_for_end
from viewer.samples import AUV, ROV, snapshot, yawed

from dq_marine.errors import InvalidInputError
from dq_marine.viewer import OffscreenViewer, ViewerError
from dq_marine.viewer.transport.browser import remove_abandoned_profiles

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 321, 203
NEAR = snapshot(current_ned=[0.2, 0.0, 0.0])
MOVED = snapshot(time=0.1, position_ned=[0.1, 0.1, 5.0], current_ned=[0.2, 0.0, 0.0])


@pytest.fixture(scope="module")
def viewer() -> Iterator[OffscreenViewer]:
    with OffscreenViewer(ROV, WIDTH, HEIGHT, caption=False) as shown:
        yield shown


def share_changed(first: np.ndarray, second: np.ndarray) -> float:
    """The share of pixels that differ visibly."""
    difference = np.abs(first.astype(int) - second.astype(int)).max(axis=2)
    return float(np.mean(difference > 8))


def blue_pixels(picture: np.ndarray) -> int:
    """How many pixels have the strong blue of the ROV's floats, which nothing else has."""
    red, green, blue = np.moveaxis(picture.astype(int), 2, 0)
    return int(np.sum((blue > 180) & (blue > green + 60) & (blue > red + 100)))


def seen_from(viewer: OffscreenViewer, offset: list[float]) -> np.ndarray:
    viewer.look_from(offset)
    return viewer.render(NEAR)


def steepness(picture: np.ndarray) -> float:
    """The mean square of the steps from one pixel to the next, which smooth edges take in several."""
    grey = picture.astype(float).mean(axis=2)
    return float(np.mean(np.diff(grey, axis=0) ** 2) + np.mean(np.diff(grey, axis=1) ** 2))


def test_size_and_type(viewer: OffscreenViewer) -> None:
    picture = viewer.render(NEAR)
    assert picture.shape == (HEIGHT, WIDTH, 3)
    assert picture.dtype == np.uint8
    assert picture.flags.writeable


def test_the_vehicle_is_in_the_middle_of_the_first_picture(viewer: OffscreenViewer) -> None:
    viewer.clear_trail()
    picture = viewer.render(NEAR)
    middle = picture[HEIGHT // 4 : -HEIGHT // 4, WIDTH // 4 : -WIDTH // 4]
    assert blue_pixels(middle) > 0.01 * WIDTH * HEIGHT
    assert blue_pixels(middle) > 0.95 * blue_pixels(picture)


def test_pixels_change_when_and_only_when_something_moves(viewer: OffscreenViewer) -> None:
    first = viewer.render(NEAR)
    assert np.array_equal(first, viewer.render(NEAR))
    assert share_changed(first, viewer.render(MOVED)) > 0.01
    turned = snapshot(time=0.2, quaternion_body_to_ned=yawed(1.0), current_ned=[0.2, 0.0, 0.0])
    assert share_changed(viewer.render(MOVED), viewer.render(turned)) > 0.01


def test_the_vehicle_grows_as_the_camera_comes_near_and_is_seen_from_below() -> None:
    places = ([3.0, 0.0, -3.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0])
    with OffscreenViewer(ROV, WIDTH, HEIGHT, caption=False) as moved:
        moved.render(NEAR)
        far, near, below = (blue_pixels(seen_from(moved, place)) for place in places)
    assert near > 4 * far > 0
    assert below < near, "the floats are above the frame"


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (1.0, float("nan"), 0.0), (1.0, 2.0)])
def test_impossible_cameras_are_refused(viewer: OffscreenViewer, offset: tuple[float, ...]) -> None:
    with pytest.raises(InvalidInputError, match="offset_ned"):
        viewer.look_from(offset)


def test_edges_are_smooth_where_that_is_asked_for(viewer: OffscreenViewer) -> None:
    viewer.clear_trail()
    plain = viewer.render(NEAR)
    with OffscreenViewer(ROV, WIDTH, HEIGHT, caption=False, smooth=True) as viewer_of_smooth:
        smooth = viewer_of_smooth.render(NEAR)
        assert np.array_equal(smooth, viewer_of_smooth.render(NEAR))
    assert 0.005 < share_changed(plain, smooth) < 0.1  # edges, and nothing else
    assert steepness(smooth) < 0.95 * steepness(plain)


def test_every_picture_shows_the_snapshot_it_was_asked_for(viewer: OffscreenViewer) -> None:
    stay = [snapshot(time=1.0 + i, position_ned=[0.0, 0.1 * (i % 2), 5.0]) for i in range(8)]
    viewer.clear_trail()
    pictures = [viewer.render(shown) for shown in stay]
    # The trail is complete after the second picture; from then on even and odd ones must agree.
    for even, odd in zip(pictures[2::2], pictures[3::2], strict=True):
        assert share_changed(even, pictures[2]) < 0.002
        assert share_changed(odd, pictures[3]) < 0.002
        assert share_changed(even, odd) > 0.01


def test_goal_and_thrust_are_seen(viewer: OffscreenViewer) -> None:
    viewer.clear_trail()
    plain = viewer.render(snapshot(time=20.0))
    goal = viewer.render(snapshot(time=20.0, goal_position_ned=[1.0, 0.0, 5.0]))
    thrust = viewer.render(snapshot(time=20.0, wrench_body=[0.0, 80.0, 0.0, 0.0, 0.0, 0.0]))
    assert share_changed(plain, goal) > 0.001
    assert share_changed(plain, thrust) > 0.001


def test_caption_and_a_second_viewer_side_by_side(viewer: OffscreenViewer) -> None:
    viewer.clear_trail()
    plain = viewer.render(NEAR)
    with OffscreenViewer(ROV, WIDTH, HEIGHT) as captioned:
        changed = np.abs(plain.astype(int) - captioned.render(NEAR)).max(axis=2) > 8
    caption = np.zeros_like(changed)
    caption[: HEIGHT // 4, : WIDTH // 2] = True
    assert (changed & caption).sum() > 50
    assert not (changed & ~caption).any()


def test_torpedo_is_drawn_and_closing_leaves_nothing() -> None:
    viewer = OffscreenViewer(AUV, 160, 120, caption=False)
    picture = viewer.render(snapshot())
    red, green, blue = np.moveaxis(picture.astype(int), 2, 0)
    assert np.sum((red > 180) & (green > 120) & (blue < 60)) > 20, "its yellow hull"

    server, browser, profile = viewer._server.pid, viewer._browser.pid, viewer._browser.profile
    assert len(group_members(browser)) > 1
    viewer.close()
    viewer.close()
    assert not alive(server)
    assert not profile.exists()
    assert all(wait_for_end(member) for member in group_members(browser))
    with pytest.raises(ViewerError, match="closed"):
        viewer.render(snapshot())


def test_a_browser_that_has_gone_is_noticed_soon() -> None:
    viewer = OffscreenViewer(ROV, 64, 48)
    viewer.render(snapshot())
    os.killpg(viewer._browser.pid, signal.SIGKILL)
    viewer._timeout = 600.0  # it must not be waited for
    started = time.monotonic()
    with pytest.raises(ViewerError, match="Chromium has ended"):
        viewer.render(snapshot(time=1.0))
    assert time.monotonic() - started < 300.0
    assert not alive(viewer._server.pid)


def test_browser_ends_with_a_killed_parent() -> None:
    script = (
        "import os, signal\n"
        "from viewer.samples import ROV, snapshot\n"
        "from dq_marine.viewer import OffscreenViewer\n"
        "viewer = OffscreenViewer(ROV, 64, 48)\n"
        "viewer.render(snapshot())\n"
        "print(viewer._server.pid, viewer._browser.pid, viewer._browser.profile, flush=True)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    search_path = os.pathsep.join(sys.path)
    result = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        timeout=600,
        env={**os.environ, "PYTHONPATH": search_path},
    )
    server, browser, profile = result.stdout.split()
    assert wait_for_end(int(server))
    assert wait_for_end(int(browser))
    # Nobody was left to remove the profile; the next viewer does.
    remove_abandoned_profiles()
    assert not Path(profile).exists()


@pytest.mark.parametrize(("width", "height"), [(0, 10), (10, -1), (10, 100_000)])
def test_impossible_sizes_are_refused(width: int, height: int) -> None:
    with pytest.raises(InvalidInputError, match="pixels"):
        OffscreenViewer(ROV, width, height)
