"""Steering by thrusters and fins: what throttle and helm do to the body, with which sign, and within which limits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from setups import sphere

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import Conditions, acceleration, decay, turning_circle, zig_zag
from dq_marine.manoeuvres.actuator_steering import ActuatorSteering, thrust_and_angle
from dq_marine.manoeuvres.linear_modes import rest_of
from dq_marine.manoeuvres.setup import prepared
from dq_marine.manoeuvres.steering import Order
from dq_marine.physics.actuators.tables import Azimuth, Thruster
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

SPEED = 2.0


def wrench_of(name, order):
    """What the actuators do to a vehicle at 2 m/s ahead, once an order has been given."""
    vehicle = load_vehicle(name)
    body = Scene(vehicle, step=1e-4, actuation="thrusters").stepper()
    body.reset(velocity_body=(SPEED, 0.0, 0.0, 0.0, 0.0, 0.0))
    ActuatorSteering(vehicle, SPEED).advance(body, order, SPEED, 1)
    return body.actuator_wrench_body


@pytest.mark.parametrize("throttle", [1.0, 0.3, -0.3, -1.0])
def test_throttle_pushes_along_x_alone(throttle):
    wrench = wrench_of("bluerov2_heavy", Order(throttle, 0.0))
    # Four T200 at 45 degrees, in balance: of 51.5 N ahead and 40.2 N astern the smaller one counts.
    assert wrench[0] == pytest.approx(throttle * 4.0 * 40.2 * math.cos(math.pi / 4.0), rel=1e-3)
    assert np.abs(wrench[[1, 2, 3, 5]]).max() < 1e-9 * abs(wrench[0])


@pytest.mark.parametrize("helm", [1.0, -0.5])
def test_helm_turns_alone(helm):
    wrench = wrench_of("bluerov2_heavy", Order(0.0, helm))
    assert wrench[5] == pytest.approx(helm * 4.0 * 40.2 * math.cos(math.pi / 4.0) * 0.267, rel=1e-2)
    assert np.abs(wrench[:3]).max() < 1e-6 * abs(wrench[5])


def test_a_rudder_turns_to_the_side_of_the_helm():
    """REMUS 100: N_uudr u^2 delta with 13.6 degrees, to starboard for positive helm, the side force to port with it."""
    wrench = wrench_of("remus100", Order(0.0, 1.0))
    assert wrench[5] == pytest.approx(4.168457 * SPEED**2 * math.radians(13.6), rel=1e-3)
    assert wrench[1] == pytest.approx(-6.10584 * SPEED**2 * math.radians(13.6), rel=1e-3)
    vehicle = load_vehicle("remus100")
    steering = ActuatorSteering(vehicle, SPEED)
    assert steering.full_moment(SPEED) == pytest.approx(wrench[5], rel=1e-3)
    assert steering.full_angle == pytest.approx(math.radians(13.6))


@pytest.mark.parametrize("moment", [3.0, -3.0, 100.0])
def test_planes_give_the_pitch_moment_that_is_asked_for(moment):
    most = 14.589599 * SPEED**2 * math.radians(13.6)
    assert wrench_of("remus100", Order(0.0, 0.0, 0.0, moment))[4] == pytest.approx(
        min(moment, most), rel=1e-3
    )


@given(thrust=st.floats(-500.0, 500.0))
def test_shaft_speeds_give_the_thrust_within_the_limits(thrust):
    thruster = Thruster(position=(0, 0, 0), direction=(1, 0, 0), thrust_forward=200.0, thrust_reverse=90.0)
    n = thruster.command_for(thrust)
    gain = 200.0 if n >= 0.0 else 90.0
    assert gain * n * abs(n) == pytest.approx(min(max(thrust, -90.0), 200.0), abs=1e-9)


@given(ahead=st.floats(-100.0, 100.0), starboard=st.floats(-100.0, 100.0), round_about=st.booleans())
def test_azimuths_push_where_they_are_asked_to(ahead, starboard, round_about):
    azimuth = Azimuth(
        position=(0, 0, 0),
        thrust_forward=100.0,
        thrust_reverse=100.0,
        angle_limit_deg=None if round_about else 90.0,
    )
    thrust, angle = thrust_and_angle(azimuth, ahead, starboard)
    made = thrust * np.array([math.cos(angle), math.sin(angle)])
    assert made == pytest.approx([ahead, starboard], abs=2e-4)
    assert abs(angle) <= azimuth.angle_limit + 1e-12
    assert thrust >= 0.0 or not round_about


def test_the_otter_turns_alike_to_both_sides():
    """Two propellers, differential thrust, afloat: port is the mirror image of starboard."""
    starboard, port = (turning_circle(load_vehicle("otter"), side=side) for side in ("starboard", "port"))
    assert starboard.settings["actuation"] == "thrusters"
    for name in ("advance", "transfer", "tactical_diameter"):
        assert getattr(starboard, name) == pytest.approx(getattr(port, name), rel=1e-6)
    assert starboard.advance > 0.0 < starboard.transfer < starboard.tactical_diameter
    assert np.abs(starboard.series.position_ned[:, 2]).max() < 0.2


def test_helm_is_as_much_rudder_as_the_angle():
    remus, otter = load_vehicle("remus100"), load_vehicle("otter")
    assert zig_zag(remus, overshoots=1).settings["helm"] == pytest.approx(10.0 / 13.6)
    assert zig_zag(otter, overshoots=1).settings["helm"] == pytest.approx(10.0 / 35.0)


def test_the_heave_of_the_otter():
    """Strongly damped and coupled with pitch: near the linear equations, about where its payload takes it to."""
    otter = load_vehicle("otter")
    result = decay(otter, motion="heave", release=0.02)
    assert result.decrement.period == pytest.approx(result.prediction.period, rel=0.05)
    heave, _, pitch = rest_of(otter)
    assert result.series.position_ned[-1, 2] == pytest.approx(heave, rel=0.02)
    assert result.series.euler[-1, 1] == pytest.approx(pitch, rel=0.02)


def test_what_steers_can_be_chosen():
    vehicle = load_vehicle("bluerov2_heavy")
    by_wrench = acceleration(vehicle, conditions=Conditions(actuation="wrench"))
    assert by_wrench.settings["actuation"] == "wrench"
    assert prepared(vehicle, Conditions()).scene.actuation == "thrusters"
    assert prepared(sphere(), Conditions()).scene.actuation == "wrench"
    with pytest.raises(InvalidInputError, match="no actuators whose force is known"):
        acceleration(sphere(), conditions=Conditions(actuation="thrusters"))
    with pytest.raises(InvalidInputError, match="'sails' is unknown; give one of"):
        Conditions(actuation="sails")


def test_actuators_that_cannot_turn_the_vehicle_are_refused():
    with pytest.raises(InvalidInputError, match=r'cannot turn it; .*actuation="wrench"'):
        ActuatorSteering(load_vehicle("remus100").model_copy(update={"fins": ()}), SPEED)
