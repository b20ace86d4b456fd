"""What a person can choose for the next episode, and the environment that follows from it."""

from __future__ import annotations

import math
from typing import Any

import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.interactive.next_episode import LEVEL, NO_LEVEL, TASK, VEHICLE, NextEpisode
from dq_marine.agents.interactive.weather import SEA, WIND, WeatherDials
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.envs.core.registry import registered_tasks, task_called
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.spectra import PiersonMoskowitz
from dq_marine.physics.weather import weather_of
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.viewer.controls import Choice, Event, Panel, Slider

PATH = EnvironmentSettings(id="dq_marine/PathFollowing-v0", keywords={"vehicle": "otter"})


def control(chosen: NextEpisode, name: str) -> Any:
    return Panel(chosen.groups())._controls[name]


@pytest.mark.sweep
def test_every_task_is_offered_with_the_vehicles_that_suit_it() -> None:
    chosen = NextEpisode(DEFAULT_ENVIRONMENT)
    tasks: Choice = control(chosen, TASK)
    assert len(tasks.options) == len(registered_tasks())
    for name in tasks.options:
        chosen.take(Event(TASK, name))
        task = task_called(name)
        suiting = {v for v in vehicle_names() if task.unsuitable(load_vehicle(v)) is None}
        assert set(control(chosen, VEHICLE).options) == suiting
        assert control(chosen, VEHICLE).value in suiting
        assert control(chosen, LEVEL).options == (NO_LEVEL, *task.levels)
        assert chosen.settings.id == task.id


def test_a_vehicle_is_kept_where_it_suits_and_left_where_it_does_not() -> None:
    chosen = NextEpisode(PATH)
    chosen.take(Event(TASK, "WaypointTracking"))
    assert chosen.settings.keywords == {"vehicle": "otter"}
    chosen.take(Event(TASK, "PipelineInspection"))
    assert chosen.settings.keywords == {"vehicle": task_called("PipelineInspection").vehicle}


def test_what_was_given_holds_for_its_own_task() -> None:
    chosen = NextEpisode(with_keywords(DEFAULT_ENVIRONMENT, current=0.0, start_radius=1.0))
    assert not chosen.changed
    chosen.take(Event(TASK, "PathFollowing"))
    assert chosen.changed
    assert "current" not in chosen.settings.keywords
    chosen.take(Event(TASK, "StationKeeping"))
    chosen.take(Event(LEVEL, "hard"))
    keywords = chosen.settings.keywords
    assert (keywords["current"], keywords["start_radius"], keywords["level"]) == (0.0, 1.0, "hard")
    chosen.take(Event(LEVEL, NO_LEVEL))
    assert "level" not in chosen.settings.keywords


def test_a_vehicle_of_ones_own_is_offered_for_its_task() -> None:
    own = load_vehicle("bluerov2").model_copy(update={"name": "My ROV"})
    chosen = NextEpisode(with_keywords(DEFAULT_ENVIRONMENT, vehicle=own))
    assert control(chosen, VEHICLE).value == "My ROV"
    assert chosen.settings.keywords["vehicle"] is own
    chosen.take(Event(VEHICLE, "bluerov2_heavy"))
    assert chosen.settings.keywords["vehicle"] == "bluerov2_heavy"


def test_sea_and_wind_are_those_of_the_level_until_a_slider_is_moved() -> None:
    chosen = NextEpisode(PATH)
    assert control(chosen, SEA[0]).value == 0.0
    assert chosen.take(Event(LEVEL, "waves"))
    said = task_called("PathFollowing").at_level("waves", {"vehicle": "otter"})["weather"]
    sea = next(part for part in said if part["kind"] == "sea")
    height: Slider = control(chosen, SEA[0])
    assert height.value == pytest.approx(sea["height"])
    assert height.least <= height.value <= height.most
    assert "weather" not in chosen.settings.keywords
    assert not chosen.take(Event(WIND[0], 5.0))
    assert not chosen.take(Event(WIND[1], 90.0))
    weather = chosen.settings.keywords["weather"]
    assert next(part for part in weather if part["kind"] == "sea")["height"] == sea["height"]
    wind = next(part for part in weather if part["kind"] == "wind")
    assert (wind["speed"], wind["direction_from"]) == (5.0, pytest.approx(math.pi / 2))


def test_a_sea_of_no_height_and_a_wind_of_no_speed_are_none() -> None:
    dials = WeatherDials(
        [{"kind": "sea", "height": 1.0, "period": 6.0}, {"kind": "wind", "speed": 5, "direction_from": 1}]
    )
    dials.take(Event(SEA[0], 0.0))
    dials.take(Event(WIND[0], 0.0))
    assert dials.weather() == []
    dials.take(Event(SEA[0], 2.0))
    dials.take(Event(SEA[2], 180.0))
    (sea,) = weather_of(dials.weather())
    assert sea.sea.spectrum.significant_height == 2.0
    assert sea.sea.spectrum.peak_period == 6.0
    assert sea.sea.direction == pytest.approx(math.pi)


def test_what_no_slider_shows_stays() -> None:
    spectrum = PiersonMoskowitz(12.0)
    given = [
        {
            "kind": "sea",
            "spectrum": "pierson_moskowitz",
            "wind_speed": 12.0,
            "spreading": 2.0,
            "slow_drift": True,
        },
        {"kind": "wind", "speed": 5.0, "direction_from": 1.0, "gusts": True},
        {"kind": "sea", "height": 1.0, "period": 12.0},
    ]
    dials = WeatherDials(given)
    values = {slider.name: slider.value for slider in dials.controls()}
    assert values[SEA[0]] == pytest.approx(spectrum.significant_height)
    assert values[SEA[1]] == pytest.approx(spectrum.peak_period)
    untouched = dials.weather()
    assert untouched[0]["spectrum"] == "pierson_moskowitz"
    dials.take(Event(SEA[2], 45.0))
    dials.take(Event(WIND[0], 8.0))
    sea, wind, other = dials.weather()
    assert (sea["spreading"], sea["slow_drift"], wind["gusts"], other["period"]) == (2.0, True, True, 12.0)
    assert sea["height"] == pytest.approx(spectrum.significant_height)
    assert len(weather_of(dials.weather())) == 4


def test_weather_that_no_slider_can_say_is_left_alone() -> None:
    class Tide:
        changes = False

        def terms(self, vehicle: Any, current_ned: Any) -> tuple[()]:
            return ()

    with pytest.raises(InvalidInputError):
        WeatherDials([Tide()])
    chosen = NextEpisode(with_keywords(DEFAULT_ENVIRONMENT, weather=[Tide()]))
    assert SEA[0] not in Panel(chosen.groups())._controls
    chosen.take(Event(LEVEL, "easy"))
    assert isinstance(chosen.settings.keywords["weather"][0], Tide)
