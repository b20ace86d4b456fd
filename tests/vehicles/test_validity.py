"""What a vehicle's numbers hold for: what a file may say, and what is said of runs that leave it."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine import BeyondValidityWarning, Jonswap, Sea
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import acceleration
from dq_marine.manoeuvres.run_notes import run_notes
from dq_marine.physics.weather.choice import weather_of
from dq_marine.vehicles import load_vehicle, vehicle_names, vehicle_sheet
from dq_marine.vehicles.validation import validated
from dq_marine.vehicles.validity import Validity

LIMITS = {"speed": 2.0, "drift_angle_deg": 30.0, "source": "a towing tank"}


def with_validity(name="otter", **limits):
    return validated(
        load_vehicle(name).model_dump() | {"validity": {"source": "a towing tank"} | limits}, name
    )


@given(st.floats(0.5, 3.0), st.floats(0.0, 90.0), st.floats(-math.pi, math.pi))
def test_a_run_within_the_limits_is_not_spoken_of(speed, drift_deg, about_x):
    drift = math.radians(drift_deg)
    across = speed * math.sin(drift)
    row = [speed * math.cos(drift), across * math.cos(about_x), across * math.sin(about_x)]
    notes = Validity(**LIMITS).notes(np.array([[0.0, 0.0, 0.0], row]))
    if min(abs(speed - 2.0), abs(drift_deg - 30.0)) > 1e-9:
        assert len(notes) == (speed > 2.0) + (drift_deg > 30.0)


def test_what_is_said_names_the_value_and_the_limit():
    (note,) = Validity(speed=2.0, source="a towing tank").notes(np.array([[2.5, 0.0, 0.0]]))
    assert note == "It went up to 2.5 m/s through the water; its numbers hold up to 2 m/s (a towing tank)."


def test_manoeuvring_in_place_is_no_drift():
    assert Validity(**LIMITS).notes(np.array([[0.0, 0.3, 0.0], [-0.1, 0.0, 0.2]])) == ()


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({}, r"validity = no limit: it says nothing; give speed"),
        ({"drift_angle_deg": 20.0}, r"validity.drift_angle_deg = 20: without a speed"),
        ({"speed": -1.0}, r"validity.speed = -1.0: must be greater than 0"),
        ({"speed": 1.0, "drift_angle_deg": 120.0}, r"validity.drift_angle_deg"),
        ({"speed": 1.0, "source": ""}, r"validity.source"),
    ],
)
def test_a_validity_that_says_nothing_or_nonsense_is_refused(limits, message):
    with pytest.raises(InvalidInputError, match=message):
        with_validity(**limits)


def test_the_sheet_shows_it():
    unknown = validated(load_vehicle("rexrov").model_dump() | {"validity": None}, "rexrov")
    assert vehicle_sheet(unknown).validity == ()
    shown = vehicle_sheet(with_validity(**LIMITS)).validity
    assert shown == ("through the water up to 2 m/s", "drift up to 30 deg")


@pytest.mark.parametrize("name", vehicle_names())
def test_each_vehicle_of_the_catalogue_says_what_its_numbers_hold_for(name):
    """And says so once of a run that leaves it: the run itself is the series of its velocities here."""
    vehicle = load_vehicle(name)
    limit = vehicle.validity.speed
    assert f"through the water up to {limit:g} m/s" in vehicle_sheet(vehicle).validity
    for speed, times in ((0.99 * limit, 0), (1.01 * limit, 1)):
        steps = np.zeros((5, 6))
        steps[1:, 0] = speed
        level = np.zeros((5, 3))
        said = run_notes(vehicle, SimpleNamespace(velocity_body=steps, euler=level))
        notes = [note for note in said if vehicle.validity.source in note]
        assert len(notes) == times
        assert all(f"up to {limit:g} m/s ({vehicle.validity.source})" in note for note in notes)


@pytest.mark.parametrize("name", vehicle_names())
def test_of_drift_and_waves_each_vehicle_has_a_limit_or_says_why_there_is_none(name):
    """The wave height of vessels is by one rule: the largest of 1000 waves, by Rayleigh's distribution."""
    vehicle = load_vehicle(name)
    validity, size = vehicle.validity, vehicle.dimensions
    assert validity.drift_angle_deg or validity.drift_angle_source
    assert validity.wave_height_source
    assert len(vehicle_sheet(vehicle).validity) == 3
    assert (validity.wave_height is None) == (vehicle.hydrostatics is None or name == "otter")
    if validity.wave_height is not None:
        crest = 0.5 * validity.wave_height * math.sqrt(0.5 * math.log(1000.0))
        assert 0.9 < crest / min(size.draft, size.height - size.draft) < 1.0


def test_a_limit_of_its_own_source_is_told_with_it():
    own = Validity(**LIMITS, drift_angle_source="a rotating arm")
    (note,) = own.notes(np.array([[1.0, 1.0, 0.0]]))
    assert note.endswith("hold up to 30 deg (a rotating arm).")
    free = Validity(speed=2.0, source="a towing tank", drift_angle_source="it is round")
    assert free.limits() == ("through the water up to 2 m/s", "drift without a limit: it is round")
    assert free.notes(np.array([[0.1, 1.9, 0.0]])) == ()


def test_waves_above_the_limit_are_warned_of():
    vessel = with_validity(wave_height=1.0)
    (low,), (high,) = (weather_of([Sea(Jonswap(height, 6.0), components=3)]) for height in (0.9, 1.1))
    low.terms(vessel, np.zeros(3))
    with pytest.warns(
        BeyondValidityWarning, match=r"waves of 1.1 m; its numbers hold up to 1 m \(a towing tank\)"
    ):
        high.terms(vessel, np.zeros(3))


@pytest.mark.sweep
def test_a_manoeuvre_that_leaves_it_says_so_once():
    slow = with_validity(speed=1.0)
    notes = acceleration(slow).notes
    assert [note for note in notes if "its numbers hold up to 1 m/s" in note] == list(notes)
    assert len(notes) == 1
