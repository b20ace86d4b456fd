"""Beams of range sensors, in real browsers: they end where they say, and can be hidden."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.devtools import Page, element, open_page
from viewer.samples import ROV, snapshot, yawed

from dq_marine.task.things import Beam
from dq_marine.viewer import LiveViewer, OffscreenViewer, Snapshot, save_replay
from dq_marine.viewer.world.beams import BEAMS, draw_beams
from dq_marine.viewer.world.drawing import Drawing

REACH, VERTICES, STEP = 4.0, 26, 0.1
"""Reach [m], vertices of a beam and its mark, and time from one snapshot to the next [s]."""

LINES = "viewer.scene_tree.find(['world', 'beams']).object.children.find((one) => one.isLineSegments)"
PLACES, COLORS = (f"{LINES}.geometry.attributes.{name}" for name in ("position", "color"))


def seeing(distances: list[float], **changes: object) -> Snapshot:
    """An ROV with a fan of beams ahead, which begin on its bow."""
    angles = np.linspace(-1.0, 1.0, len(distances))
    beams = (
        Beam((math.cos(angle), math.sin(angle), 0.0), distance, REACH, (0.2, 0.0, 0.0))
        for angle, distance in zip(angles, distances, strict=True)
    )
    return snapshot(beams=tuple(beams), **changes)


def moments() -> list[Snapshot]:
    """A turn, in which an echo comes nearer and one is lost."""
    return [
        seeing(
            [REACH, 3.0 - 0.2 * i, 1.0 if i < 5 else REACH],
            time=STEP * i,
            quaternion_body_to_ned=yawed(0.3 * i),
        )
        for i in range(10)
    ]


def key_b(page: Page) -> None:
    page.evaluate("document.dispatchEvent(new KeyboardEvent('keydown', {code: 'KeyB', bubbles: true}))")


def test_without_beams_nothing_is_drawn_or_placed() -> None:
    assert draw_beams([snapshot()], ROV) == []
    drawing = Drawing(ROV)
    drawing.appear(snapshot())
    assert BEAMS not in drawing.placements(snapshot())


def test_mounts_are_told_once_unless_they_turn() -> None:
    def mounts(snapshots: list[Snapshot]) -> np.ndarray:
        (message,) = draw_beams(snapshots, ROV)
        packed = message.content["object"]["object"]["userData"]["mounts"]
        return np.frombuffer(packed.data, "<f4").reshape(-1, 7)

    assert len(mounts(moments())) == 3
    turning = [
        snapshot(time=float(i), beams=(Beam((math.cos(i), math.sin(i), 0.0), 1.0, REACH),)) for i in range(4)
    ]
    assert_allclose(mounts(turning)[:, 3], np.cos(range(4)), rtol=1e-6)
    gone = [*turning, snapshot(time=4.0)]
    assert mounts(gone)[-1].tolist() == [0.0] * 7


@pytest.fixture(scope="module")
def replay(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    path = tmp_path_factory.mktemp("beams") / "beams.html"
    save_replay(path, moments(), ROV)
    with open_page(path.as_uri(), height=560) as shown:  # lower ones have no legend
        yield shown


@pytest.mark.browser
def test_in_a_replay_beams_end_at_what_they_tell_at_that_time(replay: Page) -> None:
    for number in (2, 7):
        shown = moments()[number]
        replay.evaluate(f"seek({shown.time}); viewer.render()")
        places = np.reshape(replay.evaluate(f"[...{PLACES}.array]"), (3, VERTICES, 3))
        colors = np.reshape(replay.evaluate(f"[...{COLORS}.array]"), (3, VERTICES, 4))
        for beam, place, color in zip(shown.beams, places, colors, strict=True):
            end = np.array(beam.origin_body) + beam.distance * np.array(beam.direction_body)
            assert_allclose(place[0], beam.origin_body, atol=1e-6)
            assert_allclose(place[1], end, atol=1e-6)
            met = beam.distance < REACH
            assert_allclose(place[2:].mean(axis=0), end, atol=1e-5)  # a mark about the echo
            assert (np.ptp(place[2:], axis=0).min() > 0.02) == met
            assert color[1, 3] == (1.0 if met else 0.0)
        turned = replay.node(BEAMS, "quaternion.toArray()")
        assert_allclose(turned, replay.node("/world/vehicle", "quaternion.toArray()"))


@pytest.mark.browser
def test_in_a_replay_the_button_and_its_key_hide_beams_and_their_legend(replay: Page) -> None:
    assert replay.evaluate(f"{element('beams')}.hidden") is False
    replay.wait_until(f"{element('legend')}.innerText.includes('echo of a beam')")
    replay.evaluate(f"{element('beams')}.click()")
    assert replay.node(BEAMS, "visible") is False
    replay.wait_until(f"!{element('legend')}.innerText.includes('echo of a beam')")
    key_b(replay)
    assert replay.node(BEAMS, "visible") is True


@pytest.mark.browser
def test_a_replay_without_beams_has_no_button_for_them(tmp_path: Path) -> None:
    save_replay(tmp_path / "plain.html", [snapshot(time=0.0), snapshot(time=1.0)], ROV)
    with open_page((tmp_path / "plain.html").as_uri()) as page:
        page.wait_until(f"{element('beams')}.hidden")
        assert page.evaluate(f"getComputedStyle({element('beams')}).display") == "none"
        key_b(page)
        assert page.node(BEAMS, "visible") is True


@pytest.mark.browser
def test_in_a_live_page_they_keep_their_shader_follow_and_can_be_hidden() -> None:
    with LiveViewer(ROV) as viewer:
        viewer.draw(seeing([1.0, 2.0], time=1.0))
        with open_page(viewer.url) as page:
            page.wait_until(f"{LINES} && {PLACES}.count === {2 * VERTICES}")
            page.evaluate(f"window.first = [{LINES}, {LINES}.material, {PLACES}]; true")
            viewer.draw(seeing([3.0, 2.0], time=1.1))
            page.wait_until(f"{LINES}.userData.distances[0] === 3")
            page.wait_until(f"Math.hypot({PLACES}.getX(1) - 0.2, {PLACES}.getY(1)) > 2.99")
            same = f"[{LINES}, {LINES}.material, {PLACES}].every((one, i) => one === first[i])"
            assert page.evaluate(same)
            for press in (lambda: page.evaluate(f"{element('view-beams')}.click()"), lambda: key_b(page)):
                before = page.node(BEAMS, "visible")
                press()
                assert page.node(BEAMS, "visible") is not before
            viewer.draw(snapshot(time=1.2))
            page.wait_until(f"!{LINES}.visible")


@pytest.mark.browser
def test_one_state_has_one_picture_with_beams() -> None:
    with OffscreenViewer(ROV, 160, 120, caption=False) as viewer:
        plain = viewer.render(snapshot())
        first = viewer.render(seeing([1.0, 2.0, REACH]))
        assert (np.abs(first.astype(int) - plain).max(axis=2) > 30).sum() > 20
        for other in (seeing([0.5, REACH]), snapshot(), seeing([2.0] * 24)) * 3:
            assert not np.array_equal(viewer.render(other), first)
            assert np.array_equal(viewer.render(seeing([1.0, 2.0, REACH])), first)
        assert np.array_equal(viewer.render(snapshot()), plain)
