"""Ships by polynomials in the standard manoeuvres: at their service speed, by the rudder alone, like mariner.m."""

import math

import pytest
from support.mariner import LENGTH, Mariner
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import Conditions, acceleration, stopping, turning_circle, zig_zag
from dq_marine.manoeuvres.setup import prepared
from dq_marine.manoeuvres.steering import Order
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

MARINER, SIGNS = load_vehicle("mariner"), {"starboard": 1, "port": -1}


@pytest.mark.parametrize("side", SIGNS)
def test_a_turn_is_that_of_mariner_m(side):
    """35 degrees of rudder, within 1 per cent: Y_rdot and N_vdot are one number here, and the approach has steered."""
    circle = turning_circle(MARINER, helm=35.0 / 40.0, side=side)
    own = (circle.advance, circle.transfer, circle.tactical_diameter, circle.steady.speed)
    assert own == pytest.approx(Mariner().turn(35.0, SIGNS[side]), rel=0.01)
    assert circle.approach_speed == pytest.approx(7.7175, rel=1e-3)
    assert circle.length == LENGTH
    assert circle.course_growth_rate < 0.0
    assert circle.notes == ()


@pytest.mark.parametrize("side", SIGNS)
@pytest.mark.parametrize("degrees", [20.0, 10.0])
def test_overshoots_are_those_of_mariner_m(degrees, side):
    test = zig_zag(MARINER, angle=math.radians(degrees), side=side, overshoots=2)
    own = [math.degrees(swing.overshoot) for swing in test.swings]
    assert own == pytest.approx(Mariner().overshoots(degrees, SIGNS[side]), rel=0.03)


def test_its_speed_is_its_own_and_its_helm_the_rudder():
    setup = prepared(MARINER, Conditions())
    assert (setup.full_speed, setup.length) == (7.7175, LENGTH)
    assert math.degrees(setup.steering.full_angle) == pytest.approx(40.0)
    lever = 0.5 * 1025.0 * LENGTH**3 * 7.7175**2
    angle = math.radians(40.0)
    assert setup.steering.full_moment(7.7175) == pytest.approx(
        lever * (139e-5 * angle - 45e-5 * angle**3), rel=1e-9
    )


def test_other_actuators_rest():
    """A bow thruster is no part of the helm."""
    content = MARINER.model_dump()
    content["thrusters"] = [
        {
            "position": (70.0, 0.0, 4.0),
            "direction": (0.0, 1.0, 0.0),
            "thrust_forward": 1e5,
            "thrust_reverse": 1e5,
        }
    ]
    vehicle = validated(content, "test")
    setup = prepared(vehicle, Conditions())
    commands = []

    class Body:
        def actuate(self, command, steps):
            commands.append((command.tolist(), steps))

    setup.steering.advance(Body(), Order(1.0, -0.5), 7.0, 3)
    assert commands == [([0.0, pytest.approx(-math.radians(20.0))], 3)]


def test_from_rest_its_propeller_brings_it_to_its_service_speed():
    run = acceleration(MARINER)
    assert run.top_speed == pytest.approx(7.7175, rel=2e-3)
    assert any("polynomials are continued: it had 0 m/s" in note for note in run.notes)


@pytest.mark.parametrize("throttle", [0.5, 0.999])
def test_it_has_no_other_throttle(throttle):
    with pytest.raises(
        InvalidInputError, match=f"throttle = {throttle}: the propeller of 'Mariner'.*give throttle 1"
    ):
        turning_circle(MARINER, conditions=Conditions(throttle=throttle))


@pytest.mark.parametrize(("order", "throttle"), [("astern", -1), ("off", 0)])
def test_it_is_not_stopped_by_its_propeller(order, throttle):
    with pytest.raises(InvalidInputError, match=f"throttle = {throttle}: the propeller of 'Mariner'"):
        stopping(MARINER, order=order)


def test_a_wrench_acts_besides_its_propeller():
    """The steady speed is where the published resistance is the limit of the file in surge."""
    setup = prepared(MARINER, Conditions(throttle=1.0, actuation="wrench"))
    u = (setup.full_speed - 7.7175) / setup.full_speed
    drag = 0.5 * 1025.0 * LENGTH**2 * setup.full_speed**2 * (184e-5 * u + 110e-5 * u**2 + 215e-5 * u**3)
    assert drag == pytest.approx(MARINER.wrench_limits[0], rel=1e-9)
    prepared(MARINER, Conditions(throttle=0.5, actuation="wrench"))


def test_the_command_says_so():
    result = CliRunner().invoke(
        app, ["manoeuvre", "mariner", "turning-circle", "--throttle", "0.5", "--no-plot"]
    )
    assert result.exit_code != 0
    assert "throttle = 0.5" in result.output
