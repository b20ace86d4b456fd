"""Currents, winds and seas of levels, in proportion to the vehicle."""

import math

import pytest

from dq_marine.cli.task_tables import level_table
from dq_marine.envs.core.definition import ForVehicle
from dq_marine.envs.core.proportion import BEAMS, current_for, current_or, disturbed, sea_for, wind_for
from dq_marine.envs.core.registry import registered_tasks, task_called
from dq_marine.envs.core.suitability import cruising_speed, steers_only_under_way
from dq_marine.physics.waves.dispersion import wave_numbers
from dq_marine.physics.weather.choice import weather_of
from dq_marine.vehicles import load_vehicle, vehicle_names

FLOATING = [name for name in vehicle_names() if load_vehicle(name).hydrostatics is not None]


@pytest.mark.parametrize("name", FLOATING)
def test_waves_at_the_peak_are_as_long_as_the_vessel_or_as_five_beams(name):
    vehicle = load_vehicle(name)
    (sea,) = sea_for(0.01).value(vehicle)
    number = float(wave_numbers([math.tau / sea["period"]], None, vehicle.gravity)[0])
    size = vehicle.dimensions
    assert math.tau / number == pytest.approx(max(size.length, BEAMS * size.width))
    assert sea["height"] == 0.01 * size.length
    assert weather_of([sea])  # a sea that does not break


@pytest.mark.parametrize("name", FLOATING)
def test_the_sea_of_a_level_is_no_higher_than_the_vessels_numbers_hold(name):
    vehicle = load_vehicle(name)
    limit = None if vehicle.validity is None else vehicle.validity.wave_height
    for task in registered_tasks():
        for level in task.levels:
            weather = task.at_level(level, {"vehicle": name}).get("weather", [])
            in_proportion = isinstance(task.levels[level].get("weather"), ForVehicle)
            for part in weather if in_proportion else []:
                assert limit is None or part.get("height", 0.0) <= limit


def test_there_are_no_waves_under_water():
    assert sea_for(0.01).value(load_vehicle("remus100")) == []


def test_currents_and_winds_are_shares_of_the_cruising_speed():
    otter = load_vehicle("otter")
    assert current_for(0.1).value(otter) == pytest.approx(0.1 * cruising_speed(otter))
    assert wind_for(2.0).value(otter)[0]["speed"] == pytest.approx(2.0 * cruising_speed(otter))
    assert set(disturbed(0.1, 2.0)) == {"current", "weather"}
    some = current_or(0.3, steers_only_under_way, 0.1)
    assert some.value(load_vehicle("rexrov")) == 0.3
    assert some.value(otter) == pytest.approx(0.1 * cruising_speed(otter))


def test_the_table_of_levels_says_what_a_number_in_proportion_means():
    rows = dict(level_table(task_called("Berthing")).rows)
    assert "current=(0.03 of the cruising speed)" in rows["`medium`"]
