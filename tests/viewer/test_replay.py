"""A replay is one whole file, plays by itself in a real browser, and follows its slider."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.commands import commands_in
from viewer.devtools import Page, open_page
from viewer.samples import ROV, snapshot, yawed

from dq_marine.errors import InvalidInputError
from dq_marine.viewer import Snapshot, save_replay

START, STEP, COUNT = 100.0, 0.05, 600


def circling() -> list[Snapshot]:
    """Twenty metres around, bow ahead, with a goal that jumps halfway."""
    moments = []
    for index in range(COUNT):
        angle = 2 * math.pi * index / COUNT
        moments.append(
            snapshot(
                time=START + STEP * index,
                position_ned=[3 * math.cos(angle), 3 * math.sin(angle), 5.0],
                # The sign of a quaternion means nothing; here it changes again and again.
                quaternion_body_to_ned=yawed(angle + math.pi / 2) * (-1) ** index,
                wrench_body=[40.0, 0, 0, 0, 0, 0],
                goal_position_ned=[0.0, 0.0, 4.0 if index < COUNT // 2 else 6.0],
            )
        )
    return moments


@pytest.fixture(scope="module")
def replay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("replay") / "circle.html"
    save_replay(path, circling(), ROV, title="A <circle> & back")
    return path


WATCH_TRAIL = """
  const line = node("world", "trail", "<object>");
  line.frustumCulled = false;
  line.onBeforeRender = () => { window.drawn_trail = trail.drawRange.count; };
"""


@pytest.fixture(scope="module")
def page(replay: Path) -> Iterator[Page]:
    with open_page(replay.as_uri()) as shown:
        shown.evaluate(WATCH_TRAIL)
        yield shown


def seek(page: Page, time: float) -> None:
    """Drag the slider."""
    page.evaluate(
        f"element('slider').value = {time}; element('slider').oninput({{target: element('slider')}})"
    )


def test_size_and_title(replay: Path) -> None:
    assert replay.stat().st_size < 5e6
    assert "<title>A &lt;circle&gt; &amp; back</title>" in replay.read_text(encoding="utf-8")


def test_attitudes_never_jump_to_the_other_sign(replay: Path) -> None:
    animation = next(c for c in commands_in(replay) if c["type"] == "set_animation")
    clip = next(a["clip"] for a in animation["animations"] if a["path"] == "/world/vehicle")
    track = next(t for t in clip["tracks"] if t["name"] == ".quaternion")
    keyframes = np.frombuffer(track["values"].data, dtype="<f4").reshape(-1, 4)
    assert len(keyframes) == COUNT
    assert np.sum(keyframes[1:] * keyframes[:-1], axis=1).min() > 0.99


@pytest.mark.browser
def test_plays_by_itself(page: Page) -> None:
    page.wait_until("viewer.animator.playing && viewer.animator.time > 0.3")
    before = page.node("/world/vehicle", "position.toArray()")
    began = page.evaluate("viewer.animator.time")
    page.wait_until(f"viewer.animator.time > {began} + 0.5")
    after = page.node("/world/vehicle", "position.toArray()")
    assert math.dist(before, after) > 0.1
    assert page.evaluate("element('play').textContent") == "Pause"


@pytest.mark.browser
def test_needs_nothing_from_outside(page: Page) -> None:
    assert page.evaluate("performance.getEntriesByType('resource').map((entry) => entry.name)") == []


@pytest.mark.browser
def test_pause_and_play(page: Page) -> None:
    page.evaluate("if (!viewer.animator.playing) element('play').click()")
    page.wait_until("viewer.animator.playing")
    page.evaluate("element('play').click()")
    held = page.node("/world/vehicle", "position.toArray()")
    page.evaluate(
        "window.frames_seen = 0; (function count() { frames_seen++; requestAnimationFrame(count); })()"
    )
    page.wait_until("frames_seen > 10")
    assert page.node("/world/vehicle", "position.toArray()") == held
    assert page.evaluate("element('play').textContent") == "Play"
    page.evaluate("element('play').click()")
    page.wait_until(f"viewer.scene_tree.find(['world', 'vehicle']).object.position.x !== {held[0]}")


@pytest.mark.browser
@pytest.mark.parametrize("index", [0, 123, 599])
def test_slider_shows_the_recorded_pose(page: Page, index: int) -> None:
    seek(page, STEP * index)
    recorded = circling()[index]
    assert_allclose(page.node("/world/vehicle", "position.toArray()"), recorded.position_ned, atol=1e-4)
    x, y, z, w = page.node("/world/vehicle", "quaternion.toArray()")
    assert abs(np.dot([w, x, y, z], recorded.quaternion_body_to_ned)) == pytest.approx(1.0, abs=1e-6)
    page.wait_until(f"element('clock').textContent === '{recorded.time:.1f} s'")
    page.wait_until(f"window.drawn_trail === {index + 1}")
    assert float(page.evaluate("element('slider').value")) == pytest.approx(STEP * index)


@pytest.mark.browser
def test_moves_evenly_between_snapshots_but_the_goal_jumps(page: Page) -> None:
    half = COUNT // 2
    seek(page, STEP * (half - 0.5))
    before, after = circling()[half - 1 : half + 1]
    middle = (before.position_ned + after.position_ned) / 2
    assert_allclose(page.node("/world/vehicle", "position.toArray()"), middle, atol=1e-3)
    assert page.node("/world/goal/ball", "position.z") == 4.0
    seek(page, STEP * (half + 0.5))
    assert page.node("/world/goal/ball", "position.z") == 6.0


@pytest.mark.browser
def test_starts_over_at_the_end(page: Page) -> None:
    seek(page, STEP * (COUNT - 1) - 0.1)
    page.evaluate("element('play').click()")
    page.wait_until("viewer.animator.playing && viewer.animator.time < 5")


@pytest.mark.browser
def test_one_snapshot_is_a_picture_without_controls(tmp_path: Path) -> None:
    save_replay(tmp_path / "one.html", [snapshot(time=3.0, position_ned=[1.0, 2.0, 5.0])], ROV)
    with open_page((tmp_path / "one.html").as_uri()) as page:
        page.wait_until("element('clock').textContent === '3.0 s'")
        assert page.node("/world/vehicle", "position.toArray()") == [1.0, 2.0, 5.0]
        assert page.evaluate("getComputedStyle(element('controls')).display") == "none"


def test_things_that_stand_still_are_not_animated(tmp_path: Path) -> None:
    still = [snapshot(time=float(i)) for i in range(3)]
    save_replay(tmp_path / "still.html", still, ROV)
    animation = next(c for c in commands_in(tmp_path / "still.html") if c["type"] == "set_animation")
    assert [clip["path"] for clip in animation["animations"]] == ["/world/clock"]


@pytest.mark.parametrize(
    ("times", "complaint"),
    [
        ([], "0 snapshots"),
        ([0.0, 1.0, 1.0], "snapshot 2 has time 1 s"),
        ([0.0, -1.0], "snapshot 1 has time -1 s"),
    ],
)
def test_bad_times_are_refused(times: list[float], complaint: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=complaint):
        save_replay(tmp_path / "bad.html", [snapshot(time=time) for time in times], ROV)
    assert list(tmp_path.iterdir()) == []


def test_bad_paths_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="does not exist"):
        save_replay(tmp_path / "absent" / "replay.html", [snapshot()], ROV)
    with pytest.raises(InvalidInputError, match="is a folder"):
        save_replay(tmp_path, [snapshot()], ROV)


def test_bad_floor_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="floor_depth is -1"):
        save_replay(tmp_path / "replay.html", [snapshot()], ROV, floor_depth=-1.0)


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "replay.html"
    target.write_text("old")

    def full_disk(*_: object, **__: object) -> None:
        raise OSError("no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full_disk)
        with pytest.raises(InvalidInputError, match="cannot be written: no space"):
            save_replay(target, [snapshot()], ROV)
    assert target.read_text() == "old"
    save_replay(target, [snapshot()], ROV)
    assert target.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert [entry.name for entry in tmp_path.iterdir()] == ["replay.html"]
