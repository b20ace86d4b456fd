"""What a vehicle file says of its actuators: what it may, and what it may not."""

import math

import pytest
from support.fleet import PROPELLER, everything, vehicle_with

from dq_marine.envs.core.view import shape_of
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle, vehicle_names

PLACE = {"position": (0.1, 0.0, 0.0), "direction": (0.0, 3.0, 4.0)}


def test_channels_stand_in_the_order_of_commands():
    channels = everything().channels
    assert [channel.name for channel in channels] == [
        "thruster 0",
        "thruster 1",
        "azimuth 0",
        "azimuth 0 angle",
        "azimuth 1",
        "azimuth 1 angle",
        "fin 0",
        "fin 1",
    ]
    assert [channel.unit for channel in channels] == ["rad/s", "1", "rad/s", "rad", "1", "rad", "rad", "rad"]
    assert channels[0][2:] == (-50.0, 60.0)
    assert channels[1][2:] == (-1.0, 1.0)
    assert channels[3][2:] == (-math.pi, math.pi)
    assert channels[4][2:] == (0.0, 1.0)
    assert channels[5][3] == pytest.approx(math.radians(40.0))
    assert channels[7][2] == pytest.approx(-math.radians(25.0))


def test_both_ways_to_tell_a_thrust_are_the_same():
    vehicle = vehicle_with(
        thrusters=[PLACE | PROPELLER, PLACE | {"thrust_forward": 72.0, "thrust_reverse": 27.5}]
    )
    by_gains, by_thrusts = vehicle.thrusters
    assert by_gains.thrust_range == pytest.approx(by_thrusts.thrust_range)
    assert by_gains.unit_direction == pytest.approx((0.0, 0.6, 0.8))


@pytest.mark.parametrize(
    ("tables", "complaint"),
    [
        ({"thrusters": [PLACE | {"thrust_forward": 5.0}]}, "thrusters.0.*not told in one way"),
        (
            {"thrusters": [PLACE | PROPELLER | {"thrust_forward": 5.0, "thrust_reverse": 5.0}]},
            "not told in one way",
        ),
        ({"thrusters": [PLACE | PROPELLER | {"dead_band": 60.0}]}, "dead_band = 60 leaves nothing"),
        ({"thrusters": [PLACE | PROPELLER | {"time_constant": -0.1}]}, "time_constant.*must not be negative"),
        ({"thrusters": [PLACE | PROPELLER | {"rate_limit": 0.0}]}, "rate_limit.*greater than 0"),
        (
            {"thrusters": [PLACE | PROPELLER | {"gain_forward": math.nan}]},
            "gain_forward.*not a finite number",
        ),
        ({"thrusters": [PLACE | PROPELLER | {"direction": (0.0, 0.0, 0.0)}]}, "direction is the zero vector"),
        ({"thrusters": [PLACE | PROPELLER | {"pitch": 1.0}]}, "pitch.*unknown key"),
        ({"thrusters": [PLACE | PROPELLER, PLACE]}, "thrusters.1 .*its thrust is missing"),
        ({"thrusters": [PLACE | PROPELLER | {"position": (5.0, 0.0, 0.0)}]}, "it lies 5 m from the origin"),
        (
            {"thrusters": [PLACE | PROPELLER | {"gain_forward": 50.0}]},
            "accelerate the vehicle's 13.5 kg beyond",
        ),
        ({"azimuths": [{"position": (0.0, 0.0, 0.0)}]}, "its thrust is missing"),
        (
            {"azimuths": [{"position": (9.0, 0.0, 0.0)} | PROPELLER]},
            "azimuths.0.position.*9 m from the origin",
        ),
        ({"fins": [{"coefficients": (0.0,) * 6, "limit_deg": 20.0}]}, "coefficients are all zero"),
        ({"fins": [{"coefficients": (1.0,) * 6, "limit_deg": 120.0}]}, "limit_deg"),
        ({"fins": [{"coefficients": (1.0,) * 5, "limit_deg": 20.0}]}, "fins.0.coefficients"),
    ],
)
def test_mistakes_are_told_with_the_field(tables, complaint):
    with pytest.raises(InvalidInputError, match=complaint):
        vehicle_with(**tables)


@pytest.mark.parametrize("name", vehicle_names())
def test_the_catalogues_actuators_are_all_drawn(name):
    vehicle = load_vehicle(name)
    assert len(shape_of(vehicle).thrusters) == len(vehicle.thrusters) + len(vehicle.azimuths)


@pytest.mark.parametrize("name", ["bluerov2", "bluerov2_heavy", "rexrov"])
def test_thrusters_reach_the_limits_of_their_file(name):
    """Each actuated axis alone, by the weaker side of every thruster: what the [limits] were made from."""
    vehicle = load_vehicle(name)
    matrix = vehicle.allocation_matrix
    for axis in range(6):
        if vehicle.wrench_limits[axis] > 0.0:
            most = sum(
                abs(gain) * min(map(abs, thruster.thrust_range))
                for gain, thruster in zip(matrix[axis], vehicle.thrusters, strict=True)
            )
            assert vehicle.wrench_limits[axis] <= 1.02 * most
