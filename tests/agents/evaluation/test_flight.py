"""Flights for people to see: the files they leave, the live page, and what is refused."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from dq_marine.agents import demo
from dq_marine.agents.controllers.dp_controller import DPController
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, marine, with_keywords
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs, far_seed, fly
from dq_marine.errors import InvalidInputError

PNG_SIGNATURE = b"\x89PNG"


def flown(plan: FlightPlan, outputs: Outputs) -> Episode:
    return fly(plan, DPController.for_env, outputs, title="test")


@pytest.fixture
def no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo, "display_present", lambda: False)


class Page:
    """Stands in for the live viewer; Ctrl-C comes with a later picture."""

    url = "http://127.0.0.1:7000"

    def __init__(self) -> None:
        self.patience = 4
        self.times: list[float] = []
        self.closed = False

    def draw(self, snapshot: Any) -> None:
        if len(self.times) == self.patience:
            raise KeyboardInterrupt
        self.times.append(snapshot.time)

    def clear_trail(self) -> None:
        pass

    def show_controls(self, groups: Any) -> None:
        pass

    def events(self) -> list[Any]:
        return []

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def page(monkeypatch: pytest.MonkeyPatch) -> Page:
    stand_in = Page()
    monkeypatch.setattr("dq_marine.viewer.live.LiveViewer", lambda *arguments, **keywords: stand_in)
    monkeypatch.setattr("dq_marine.viewer.pacing.RealTimePacer.wait_until", lambda self, time: None)
    return stand_in


def test_files_are_written(tmp_path: Path) -> None:
    outputs = Outputs(html=tmp_path / "replay.html", plot=tmp_path / "errors.png")
    episode = flown(FlightPlan(DEFAULT_ENVIRONMENT, seconds=1.0), outputs)
    assert episode.time[-1] == pytest.approx(1.0)
    assert "<html" in (tmp_path / "replay.html").read_text(encoding="utf-8")[:2000].lower()
    assert (tmp_path / "errors.png").read_bytes().startswith(PNG_SIGNATURE)


def test_start_distance_is_kept() -> None:
    starts = []
    for seed in (0, 0, 1):
        episode = flown(
            FlightPlan(DEFAULT_ENVIRONMENT, seconds=0.5, seed=seed, start_distance=3.0), Outputs()
        )
        distance = episode.measured["position_error"]
        assert distance[0] == pytest.approx(3.0)
        starts.append(distance[-1])
    assert starts[0] == starts[1]
    assert starts[0] != starts[2]


@pytest.mark.parametrize(("patience", "periods"), [(4, 3), (1, 0)])
def test_interrupted_live_flight_still_writes_its_files(
    tmp_path: Path, page: Page, patience: int, periods: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """The start and `periods` control periods are seen; the one that Ctrl-C fell into does not count."""
    page.patience = patience
    outputs = Outputs(live=True, html=tmp_path / "replay.html", plot=tmp_path / "errors.png")
    episode = flown(FlightPlan(DEFAULT_ENVIRONMENT, seconds=10.0), outputs)
    np.testing.assert_allclose(page.times, 0.1 * np.arange(patience))
    assert len(episode.actions) == periods
    assert len(episode.time) == periods + 1
    assert page.closed
    assert page.url in capsys.readouterr().err
    assert (tmp_path / "replay.html").is_file()
    assert (tmp_path / "errors.png").is_file()


def test_other_flights_are_not_interruptible(page: Page) -> None:
    """Where nobody asked for it, Ctrl-C ends the program as usual."""
    env = make_environment(DEFAULT_ENVIRONMENT, render_mode="human")
    with pytest.raises(KeyboardInterrupt):
        fly_episode(env, DPController.for_env(env), seed=0)


@pytest.mark.parametrize("vehicle", ["bluerov2_heavy", "rexrov"])
def test_a_flight_without_a_seed_begins_far_away(vehicle: str) -> None:
    """It is the first such seed, so that the same flight is flown again."""
    environment = with_keywords(DEFAULT_ENVIRONMENT, vehicle=vehicle)
    env = make_environment(environment)
    seed = far_seed(FlightPlan(environment))
    distances = []
    for one in range(seed + 1):
        _, info = env.reset(seed=one)
        distances.append(info["position_error"])
    radius = marine(env).start_radius  # type: ignore[attr-defined]
    assert distances[-1] >= 0.5 * radius > max(distances[:-1], default=0.0)
    if vehicle == "bluerov2_heavy":
        assert seed > 0  # seed 0 begins at the goal
        episode = flown(FlightPlan(environment, seconds=0.2), Outputs())
        assert (episode.seed, episode.measured["position_error"][0]) == (seed, distances[-1])


def test_a_flight_that_says_where_to_start_has_seed_0() -> None:
    for plan in (
        FlightPlan(DEFAULT_ENVIRONMENT, start_distance=0.0),
        FlightPlan(DEFAULT_ENVIRONMENT, start={"position": (0.0, 0.0, 5.0)}),
    ):
        assert far_seed(plan) == 0


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf")])
def test_impossible_times_are_refused(seconds: float) -> None:
    with pytest.raises(InvalidInputError, match="seconds = "):
        flown(FlightPlan(DEFAULT_ENVIRONMENT, seconds=seconds), Outputs())


def test_a_start_outside_the_workspace_is_refused() -> None:
    with pytest.raises(
        InvalidInputError, match=r"start distance = 6 m; .* less than the workspace radius, 6 m"
    ):
        flown(FlightPlan(DEFAULT_ENVIRONMENT, start_distance=6.0), Outputs())


def test_files_that_cannot_be_are_refused(tmp_path: Path) -> None:
    plan = FlightPlan(DEFAULT_ENVIRONMENT, seconds=0.2)
    with pytest.raises(
        InvalidInputError, match=r"errors\.xyz has no ending that pictures have; give one of .*png"
    ):
        flown(plan, Outputs(plot=tmp_path / "errors.xyz"))
    with pytest.raises(InvalidInputError, match="does not exist"):
        flown(plan, Outputs(plot=tmp_path / "no" / "errors.png"))
    with pytest.raises(InvalidInputError, match="does not exist"):
        flown(plan, Outputs(html=tmp_path / "no" / "replay.html"))
    with pytest.raises(InvalidInputError, match="does not exist"):
        flown(plan, Outputs(trajectory=tmp_path / "no" / "flight.csv"))
    with pytest.raises(
        InvalidInputError, match=r"flight\.txt has no ending that trajectories have; give one of \.csv"
    ):
        flown(plan, Outputs(trajectory=tmp_path / "flight.txt"))
    with pytest.raises(InvalidInputError, match=r"flight\.avi has the ending"):
        flown(plan, Outputs(mp4=tmp_path / "flight.avi"))
    with pytest.raises(InvalidInputError, match="fps = 0"):
        flown(plan, Outputs(mp4=tmp_path / "flight.mp4", fps=0.0))


def test_demo_writes_its_files_and_says_where(tmp_path: Path, no_display: None) -> None:
    console = Console(file=io.StringIO(), width=200)
    demo.run_demo(tmp_path / "demo", console)
    text = console.file.getvalue()  # type: ignore[attr-defined]
    for name in (*(flight.file for flight in demo.FLIGHTS), "index.html", "errors.png"):
        assert (tmp_path / "demo" / name).stat().st_size > 10_000
        assert str(tmp_path / "demo" / name) in text
    assert "2.000 m" in text
    assert "settled" in text
    assert "sides kept" in text
    assert "Now the same, live" not in text


def test_demo_goes_live_where_there_is_a_display(
    tmp_path: Path, page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(demo, "display_present", lambda: True)
    monkeypatch.setattr(demo, "FLIGHTS", (demo.STATION,))
    demo.run_demo(tmp_path, Console(file=io.StringIO()))
    assert page.times
    assert page.closed


def test_demo_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidInputError, match="cannot be made"):
        demo.run_demo(tmp_path / "file" / "demo", Console(file=io.StringIO()))
