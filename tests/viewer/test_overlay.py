"""Several flights in one scene: each has its track at its times, its colour, its place in the legend and the plots."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.commands import commands_in, constant_in, track_in
from viewer.devtools import Page, open_page
from viewer.samples import AUV, ROV, snapshot, yawed

from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import PiersonMoskowitz
from dq_marine.task.things import Column, Thing
from dq_marine.viewer import Flight, Shape, Snapshot, make_overlay, save_overlay
from dq_marine.viewer.models.paint import FLIGHT_COLORS

START, STEP = 10.0, 0.25
GOAL = [0.0, 1.0, 5.0]
PILLAR = Thing(Column(0.3, 5.0), (2.0, 0.0, 5.0))
NAMES = ("short & <first>", "long", "own goal")
COUNTS = (41, 81, 61)


def circling(count: int, radius: float, step: float = STEP, **changes: Any) -> tuple[Snapshot, ...]:
    """A vehicle on a circle, among a pillar, a current and a goal that all flights have."""
    plain: dict[str, Any] = {"goal_position_ned": GOAL, "things": (PILLAR,), "current_ned": [0.1, 0.0, 0.0]}
    return tuple(
        snapshot(
            time=START + step * number,
            position_ned=[radius * math.sin(angle), radius * (1.0 - math.cos(angle)), 5.0],
            quaternion_body_to_ned=yawed(angle),
            wrench_body=[10.0, 0, 0, 0, 0, 0],
            **{**plain, **changes},
        )
        for number, angle in enumerate(0.04 * np.arange(count))
    )


def flights() -> list[Flight]:
    first, second, third = NAMES
    errors = np.geomspace(1e-3, 10.0, COUNTS[1])
    errors[5] = np.nan
    return [
        Flight(first, circling(COUNTS[0], 2.0), ROV, plots={"error [m]": np.full(COUNTS[0], 0.5)}),
        Flight(second, circling(COUNTS[1], 3.0), AUV, "came </script> late", plots={"error [m]": errors}),
        Flight(third, circling(COUNTS[2], 1.0, goal_position_ned=[0.0, 0.0, 4.0]), ROV),
    ]


@pytest.fixture(scope="module")
def overlay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("overlay") / "three.html"
    save_overlay(path, flights(), title="Three at once")
    return path


LOOK_IN = """
  window.trail_of = (number) => node("world", "flights", String(number), "trail", "<object>").geometry.drawRange.count;
  window.colours_in_plot = () => {
    const canvas = document.querySelector("#overlay canvas"), {width, height} = canvas;
    const {data} = canvas.getContext("2d").getImageData(0, 0, width, height), found = new Set();
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] === 255) { found.add([0, 1, 2].map((c) => data[i + c].toString(16).padStart(2, "0")).join("")); }
    }
    return [...found];
  };
"""


@pytest.fixture(scope="module")
def page(overlay: Path) -> Iterator[Page]:
    with open_page(overlay.as_uri(), width=900, height=700) as shown:
        shown.wait_until("document.querySelectorAll('#overlay .cursor').length === 1")
        shown.evaluate(LOOK_IN)
        yield shown


VEHICLES = ("/world/vehicle", "/world/flights/1/vehicle", "/world/flights/2/vehicle")
SECONDS = STEP * (max(COUNTS) - 1)
"""Of the longest flight."""


@pytest.mark.parametrize("number", range(3))
def test_each_flight_has_its_track_at_its_times(overlay: Path, number: int) -> None:
    recorded = flights()[number].snapshots
    times, positions = track_in(commands_in(overlay), VEHICLES[number], "position")
    count = len(recorded)
    assert_allclose(times[:count], [one.time - START for one in recorded], atol=1e-5)
    assert_allclose(positions[:count], [one.position_ned for one in recorded], atol=1e-6)
    # Each clip is as long as the longest, or it would begin again on its own: a vehicle stands where its flight ended.
    assert times[-1] == pytest.approx(SECONDS)
    assert_allclose(positions[count - 1 :], np.tile(positions[-1], (len(positions) - count + 1, 1)))


def test_the_clock_runs_until_the_last_flight_ends(overlay: Path) -> None:
    times, values = track_in(commands_in(overlay), "/world/clock", "position")
    assert_allclose(values[:, 0], START + times, atol=1e-5)
    assert times[-1] == pytest.approx(SECONDS)


def test_what_is_common_is_drawn_once_and_a_goal_of_its_own_beside_it(overlay: Path) -> None:
    drawn = [one["path"] for one in commands_in(overlay) if one["type"] == "set_object"]
    assert len(drawn) == len(set(drawn))
    assert [path for path in drawn if path.startswith("/world/things")] == ["/world/things/0"]
    goals = [path for path in drawn if "/goal/" in path]
    assert goals == [
        f"{place}/goal/{kind}" for place in ("/world", "/world/flights/2") for kind in ("ghost", "ball")
    ]


def test_trail_and_legend_have_the_colour_of_the_flight(overlay: Path) -> None:
    told = constant_in(overlay, "overlay")
    assert [one["name"] for one in told["flights"]] == list(NAMES)
    assert [int(one["color"][1:], 16) for one in told["flights"]] == list(FLIGHT_COLORS[:3])
    lines = {one["path"]: one["object"]["materials"][0]["color"] for one in commands_in(overlay)
             if one["type"] == "set_object" and one["path"].endswith("/trail")}  # fmt: skip
    assert lines == {one["trail"]: int(one["color"][1:], 16) for one in told["flights"]}


def test_what_is_not_finite_is_left_out_of_plots(overlay: Path) -> None:
    told = constant_in(overlay, "overlay")
    assert told["flights"][1]["plots"]["error [m]"][5] is None
    assert told["charts"] == [
        {"label": "error [m]", "low": pytest.approx(1e-3), "high": 10.0, "logarithmic": True}
    ]
    assert "NaN" not in overlay.read_text(encoding="utf-8").partition("const messages")[2]


def seek(page: Page, time: float) -> None:
    """Go to a time since the start [s], and wait until that is shown."""
    page.evaluate(f"seek({time})")
    page.wait_until(f"element('clock').textContent === '{START + time:.1f} s'")


@pytest.mark.browser
def test_vehicles_stand_where_they_were_at_the_time_of_the_cursor(page: Page) -> None:
    for time in (2.5, 12.5, SECONDS):
        seek(page, time)
        index = round(time / STEP)
        for path, flight in zip(VEHICLES, flights(), strict=True):
            where = flight.snapshots[min(index, len(flight.snapshots) - 1)].position_ned
            assert_allclose(page.node(path, "position.toArray()"), where, atol=1e-4)
        page.wait_until(f"trail_of(1) === {index + 1}")
        ended = page.evaluate("[...document.querySelectorAll('.ended')].map((one) => one.textContent)")
        assert ended == [
            "ended at 20.0 s" if time > 10.0 else "",
            "",
            "ended at 25.0 s" if time > 15.0 else "",
        ]
        share = page.evaluate(
            "parseFloat(document.querySelector('.cursor').style.left) / "
            "document.querySelector('#overlay canvas').clientWidth"
        )
        assert share == pytest.approx(time / SECONDS, abs=0.01)


@pytest.mark.browser
def test_a_flight_is_hidden_and_shown_by_its_name(page: Page) -> None:
    legend = page.evaluate(
        "[...document.querySelectorAll('#overlay label')].map((one) => one.innerText.trim())"
    )
    assert [words.splitlines()[0] for words in legend] == list(NAMES)
    assert "came </script> late" in page.evaluate("element('overlay-flights').innerText")
    inked = "colours_in_plot()"
    yellow, pink = (f"{color:06x}" for color in FLIGHT_COLORS[:2])
    assert {yellow, pink} <= set(page.evaluate(inked))
    for number, paths in enumerate(
        (["/world/vehicle", "/world/trail"], ["/world/flights/1"], ["/world/flights/2"])
    ):
        box = f"document.querySelectorAll('#overlay [type=checkbox]')[{number}]"
        for shown in (False, True):
            page.evaluate(f"{box}.click()")
            assert [page.node(path, "visible") for path in paths] == [shown] * len(paths)
            assert (number == 2) or ((yellow, pink)[number] in page.evaluate(inked)) is shown


@pytest.mark.browser
def test_the_camera_follows_whom_one_chooses(page: Page) -> None:
    seek(page, 12.5)
    from_vehicle = """(() => {
      const {camera} = viewer, vehicle = node(...'PATH'.slice(1).split('/')).getWorldPosition(camera.position.clone());
      return camera.getWorldPosition(camera.position.clone()).sub(vehicle).toArray();
    })()"""
    before = page.evaluate(from_vehicle.replace("PATH", VEHICLES[0]))
    for number in (1, 0):
        page.evaluate(
            f"document.querySelectorAll('#overlay [name=followed]')[{number}].click(); frames_seen = 0;"
        )
        page.evaluate("requestAnimationFrame(() => requestAnimationFrame(() => { frames_seen = 2; }))")
        page.wait_until("frames_seen === 2")
        assert_allclose(page.evaluate(from_vehicle.replace("PATH", VEHICLES[number])), before, atol=1e-6)


@pytest.mark.browser
def test_a_press_on_a_plot_goes_to_its_time(page: Page) -> None:
    page.evaluate("""(() => {
      const canvas = document.querySelector('#overlay canvas'), {left, width} = canvas.getBoundingClientRect();
      canvas.setPointerCapture = () => {};  // only a pointer of flesh can be captured
      canvas.dispatchEvent(new PointerEvent('pointerdown', {clientX: left + width / 2}));
    })()""")
    page.wait_until(f"Math.abs(animator.time - {SECONDS / 2}) < 0.1 && !animator.playing")


@pytest.mark.browser
def test_the_legend_leaves_out_thrust_and_one_track(page: Page) -> None:
    page.wait_until("element('legend').innerText.includes('current')")
    words = page.evaluate("element('legend').innerText")
    assert "thrust" not in words
    assert "track" not in words
    assert "goal" in words


def test_after_its_end_the_first_stands_still_and_the_others_go_on(tmp_path: Path) -> None:
    path = tmp_path / "two.html"
    save_overlay(path, [Flight("a", circling(2, 1.0), ROV), Flight("b", circling(30, 2.0, step=0.1), ROV)])
    times, values = track_in(commands_in(path), "/world/vehicle", "position")
    assert times[-1] == pytest.approx(2.9)
    assert_allclose(values[1:], np.tile(values[1], (len(values) - 1, 1)))


def test_flights_that_end_together_but_for_rounding_have_no_second_end(tmp_path: Path) -> None:
    path = tmp_path / "two.html"
    save_overlay(
        path, [Flight("a", circling(10, 1.0, step=0.1), ROV), Flight("b", circling(7, 1.0, step=0.15), ROV)]
    )
    times, _ = track_in(commands_in(path), "/world/flights/1/vehicle", "position")
    assert_allclose(times, 0.15 * np.arange(7), atol=1e-5)


def test_the_camera_is_as_far_as_the_largest_vehicle_wants(tmp_path: Path) -> None:
    path, big = tmp_path / "two.html", replace(ROV, length=4.0)

    def distance(*shapes: Shape) -> float:
        save_overlay(path, [Flight(str(n), circling(2, 1.0), shape) for n, shape in enumerate(shapes)])
        placed = next(one for one in commands_in(path) if one.get("property") == "position")
        return math.hypot(*placed["value"])

    assert distance(ROV, big) == distance(big) > distance(ROV)


def test_currents_that_differ_are_not_drawn(tmp_path: Path) -> None:
    path = tmp_path / "two.html"
    save_overlay(
        path, [Flight("a", circling(3, 1.0), ROV), Flight("b", circling(3, 1.0, current_ned=[0, 0, 0]), ROV)]
    )
    dial = next(one for one in commands_in(path) if one["path"] == "/world/dials/current")
    assert dial["matrix"][12:15] == [0.0, 0.0, 0.0]


SEA = Sea(PiersonMoskowitz(8.0))
BOAT = Shape(2.0, 1.0, 0.5, kind="catamaran")


@pytest.mark.parametrize(
    ("other", "pattern"),
    [
        ({"name": "a"}, r"'a' is of 2 flight"),
        ({"name": " "}, r"' ' is of 1 flight"),
        ({"snapshots": ()}, "0 snapshots of the flight 'b'"),
        ({"snapshots": circling(3, 1.0)[::-1]}, "of the flight 'b' has time"),
        ({"snapshots": (snapshot(time=3.0),)}, "begin at 10 s and 3 s"),
        ({"snapshots": circling(3, 1.0, sea=SEA)}, "different seas.*side by side"),
        ({"snapshots": circling(3, 1.0, things=())}, "different things around them at 10 s.*side by side"),
        (
            {"snapshots": circling(3, 1.0, things=(PILLAR._replace(position_ned=(2.0, 0.1, 5.0)),))},
            "different things",
        ),
        ({"shape": BOAT}, "floats.*side by side"),
        ({"plots": {"speed": [1.0, 2.0]}}, r"'speed' of the flight 'b' has values of shape \(2,\)"),
    ],
)
def test_what_cannot_be_overlaid_is_refused(other: dict[str, Any], pattern: str) -> None:
    one = Flight("a", circling(3, 1.0), ROV)
    with pytest.raises(InvalidInputError, match=pattern):
        make_overlay([one, replace(Flight("b", circling(3, 1.0), ROV), **other)])


def test_none_and_too_many_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="there are 0 flights"):
        save_overlay(tmp_path / "none.html", [])
    many = [Flight(str(number), circling(2, 1.0), ROV) for number in range(7)]
    with pytest.raises(InvalidInputError, match=r"7 flights, and colours for 6.*side by side"):
        make_overlay(many)
    assert make_overlay(many[:1]).page.startswith("<!DOCTYPE html>")
    assert not list(tmp_path.iterdir())
