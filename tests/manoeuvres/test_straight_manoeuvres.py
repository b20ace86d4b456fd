"""Acceleration and stopping of bodies that move along a line: closed forms."""

import math

import numpy as np
import pytest
from setups import LIMITS, LINEAR, mass_of, sphere

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import Conditions, acceleration, stopping
from dq_marine.vehicles import load_vehicle

THRUST = LIMITS[0]
QUADRATIC = (300.0, 600.0, 600.0, 50.0, 50.0, 50.0)
NONE = (0.0,) * 6


def linear_case():
    """Speed and time constant: u = U (1 - exp(-t/T))."""
    vehicle = sphere()
    return vehicle, THRUST / LINEAR[0], mass_of(vehicle)[0] / LINEAR[0]


def quadratic_case():
    """Speed and time scale: u = U tanh(t/T), T = m U / X."""
    vehicle = sphere(NONE, QUADRATIC)
    speed = math.sqrt(THRUST / QUADRATIC[0])
    return vehicle, speed, mass_of(vehicle)[0] * speed / THRUST


def test_acceleration_with_linear_damping():
    vehicle, speed, constant = linear_case()
    result = acceleration(vehicle)
    assert result.notes == ()
    assert result.top_speed == pytest.approx(speed, rel=3e-3)
    exact = speed * (1.0 - np.exp(-result.series.time / constant))
    assert np.abs(result.series.velocity_body[:, 0] - exact).max() < 1e-10 * speed
    # The top speed is a little short of the asymptote: the times are those of the speed that was reached.
    for time, share in ((result.time_63, 1.0 - math.exp(-1.0)), (result.time_90, 0.9)):
        assert time == pytest.approx(-constant * math.log(1.0 - share * result.top_speed / speed), rel=1e-4)
    way = speed * (result.time_90 - constant * (1.0 - math.exp(-result.time_90 / constant)))
    assert result.distance_90 == pytest.approx(way, rel=1e-3)


def test_acceleration_with_quadratic_damping():
    vehicle, speed, scale = quadratic_case()
    result = acceleration(vehicle)
    exact = speed * np.tanh(result.series.time / scale)
    assert np.abs(result.series.velocity_body[:, 0] - exact).max() < 1e-5 * speed
    assert result.top_speed == pytest.approx(speed, rel=1e-3)
    assert result.time_90 == pytest.approx(scale * math.atanh(0.9 * result.top_speed / speed), rel=1e-3)


def test_half_throttle_halves_the_speed_of_linear_damping():
    vehicle, speed, _ = linear_case()
    assert acceleration(vehicle, conditions=Conditions(throttle=0.5)).top_speed == pytest.approx(
        0.5 * speed, rel=5e-3
    )


def test_stopping_with_linear_damping():
    """Full astern from U: u = 2 U exp(-t/T) - U, so that T ln 2 and U T (1 - ln 2) stop it."""
    vehicle, speed, constant = linear_case()
    result = stopping(vehicle)
    assert result.approach_speed == pytest.approx(speed, rel=1e-6)
    assert result.stopping_time == pytest.approx(constant * math.log(2.0), rel=1e-3)
    assert result.head_reach == pytest.approx(speed * constant * (1.0 - math.log(2.0)), rel=1e-3)
    assert result.track_reach == pytest.approx(result.head_reach, rel=1e-5)
    assert result.lateral_deviation == pytest.approx(0.0, abs=1e-12)


def test_stopping_with_quadratic_damping():
    """Full astern from U: u = U tan(pi/4 - t/T), so that T pi/4 and U T ln(2)/2 stop it."""
    vehicle, speed, scale = quadratic_case()
    result = stopping(vehicle)
    assert result.stopping_time == pytest.approx(0.25 * math.pi * scale, rel=1e-3)
    assert result.head_reach == pytest.approx(0.5 * math.log(2.0) * speed * scale, rel=1e-3)


def test_stopping_with_the_thrust_off():
    """Linear damping leaves a twentieth after T ln 20."""
    vehicle, speed, constant = linear_case()
    result = stopping(vehicle, order="off")
    assert result.stopping_time == pytest.approx(constant * math.log(20.0), rel=1e-3)
    assert result.head_reach == pytest.approx(0.95 * speed * constant, rel=1e-3)
    assert result.quantities()[2].limit is None


def test_depth_is_held():
    """By the heave force, the weight being a little less than the buoyancy."""
    content = sphere().model_dump()
    content["buoyancy"]["volume"] *= 1.005
    vehicle = type(sphere()).model_validate(content)
    depth = acceleration(vehicle).series.position_ned[:, 2]
    assert np.abs(depth - depth[0]).max() < 0.01


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"linear": NONE}, "damping.*surge is 0.*give"),
        ({"limits": (0.0, *LIMITS[1:])}, r"limits.wrench\[0\] = 0.*drive it ahead"),
        ({"limits": (*LIMITS[:5], 0.0)}, r"limits.wrench\[5\] = 0.*turn it"),
    ],
)
def test_vehicles_that_cannot_be_steered_are_refused(change, message):
    with pytest.raises(InvalidInputError, match=message):
        acceleration(sphere(**change))


@pytest.mark.parametrize("throttle", [0.0, -0.5, 1.5, math.nan, "full"])
def test_wrong_throttles_are_refused(throttle):
    with pytest.raises(InvalidInputError, match="throttle"):
        Conditions(throttle=throttle)


def test_wrong_orders_are_refused():
    with pytest.raises(InvalidInputError, match="'sideways' is unknown; give 'astern' or 'off'"):
        stopping(sphere(), order="sideways")


@pytest.mark.sweep
def test_a_vehicle_that_tumbles_says_so():
    """BlueROV2 without lift, as published: nothing actuates pitch, and at full throttle Munk's moment turns it over."""
    whole = load_vehicle("bluerov2")
    vehicle = whole.model_copy(update={"damping": whole.damping.model_copy(update={"couplings": ()})})
    assert not any("throttle" in note for note in acceleration(whole).notes)
    assert any("try less throttle" in note for note in acceleration(vehicle).notes)
    assert not any(
        "throttle" in note for note in acceleration(vehicle, conditions=Conditions(throttle=0.1)).notes
    )
