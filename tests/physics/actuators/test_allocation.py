"""Thrust allocation: the pseudoinverse where it suffices, optimal where it does not, in actuators' own commands."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.actuated import actuator_wrench
from support.fleet import everything, twin_screw, vehicle_with

from dq_marine.errors import InvalidInputError
from dq_marine.physics.actuators.allocation import ThrustAllocator
from dq_marine.vehicles import Vehicle, load_vehicle

HEAVY = load_vehicle("bluerov2_heavy")

wrenches = st.tuples(*[st.floats(-400.0, 400.0)] * 3, *[st.floats(-120.0, 120.0)] * 3)


def supply_vessel():
    """Two tunnels at the bow, two azimuths at the stern, in proportion to an offshore vessel's."""
    thrust = {"thrust_forward": 30.0, "thrust_reverse": 30.0}
    return vehicle_with(
        thrusters=[{"position": (x, 0.0, 0.0), "direction": (0.0, 1.0, 0.0)} | thrust for x in (0.4, 0.38)],
        azimuths=[
            {"position": (-0.4, y, 0.0), "thrust_forward": high, "thrust_reverse": 0.0}
            for y, high in ((0.1, 42.0), (-0.1, 65.0))
        ],
    )


@given(share=st.floats(0.0, 0.19), direction=wrenches)
def test_where_it_is_reachable_it_is_the_pseudoinverse(share, direction):
    """The least effort without saturation is B+ tau, thrusts being alike."""
    wanted = share * np.array(direction) / max(1.0, np.abs(direction).max())
    wanted *= HEAVY.wrench_limits
    allocation = ThrustAllocator(HEAVY).allocate(wanted)
    thrusts = np.linalg.pinv(HEAVY.allocation_matrix) @ wanted
    own = [51.5 * n * n if n >= 0.0 else -40.2 * n * n for n in allocation.command]
    assert own == pytest.approx(thrusts, abs=1e-6)
    assert allocation.unreachable == pytest.approx(np.zeros(6), abs=1e-6)


@settings(max_examples=60)
@given(wanted=wrenches)
def test_beyond_reach_it_is_optimal(wanted):
    """Karush-Kuhn-Tucker: no thrust within its bounds pulls, and none at a bound would rather go back."""
    allocation = ThrustAllocator(HEAVY, effort=1e-5).allocate(wanted)
    weights = np.array([1.0] * 3 + [1.0 / HEAVY.dimensions.length] * 3)
    high, low = 51.5, -40.2
    thrusts = np.array([high * n * n if n >= 0.0 else low * n * n for n in allocation.command])
    assert (thrusts <= high).all()
    assert (thrusts >= low).all()
    gradient = HEAVY.allocation_matrix.T @ (weights**2 * (HEAVY.allocation_matrix @ thrusts - wanted))
    slack = 1e-4
    assert (gradient[thrusts < high - 1e-6] >= -slack).all()
    assert (gradient[thrusts > low + 1e-6] <= slack).all()
    reached = HEAVY.allocation_matrix @ thrusts
    assert allocation.wrench_body == pytest.approx(reached, abs=1e-9)
    assert allocation.unreachable == pytest.approx(np.array(wanted) - reached, abs=1e-9)


@settings(max_examples=60)
@given(wanted=wrenches)
def test_a_vehicle_and_its_mirror_image_command_alike(wanted):
    """Port and starboard change places when Y, K and N change sign."""
    mirrored = np.array(wanted) * [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]
    allocator = ThrustAllocator(HEAVY)
    own, other = (allocator.allocate(one).command for one in (wanted, mirrored))
    # Of thrusts: the square root of one near 0 magnifies round-off.
    assert other * np.abs(other) == pytest.approx((own * np.abs(own))[[1, 0, 3, 2, 5, 4, 7, 6]], abs=1e-5)


@settings(max_examples=60)
@given(wanted=wrenches)
def test_azimuths_stay_within_their_circle(wanted):
    vessel = supply_vessel()
    allocation = ThrustAllocator(vessel).allocate(wanted)
    for channel, command in zip(vessel.channels, allocation.command, strict=True):
        assert channel.low - 1e-9 <= command <= channel.high + 1e-9
    steady = actuator_wrench(vessel, allocation.command, np.zeros(6))
    assert allocation.wrench_body == pytest.approx(steady, abs=1e-9)


@given(x=st.floats(-60.0, 60.0), y=st.floats(-30.0, 30.0), n=st.floats(-8.0, 8.0))
def test_azimuths_give_any_horizontal_wrench_within_reach(x, y, n):
    allocation = ThrustAllocator(supply_vessel()).allocate((x, y, 0.0, 0.0, 0.0, n))
    assert allocation.unreachable[[0, 1, 5]] == pytest.approx(np.zeros(3), abs=1e-6)


def test_an_azimuth_beyond_its_circle_keeps_its_direction():
    vessel = vehicle_with(
        azimuths=[{"position": (0.0, 0.0, 0.0), "thrust_forward": 10.0, "thrust_reverse": 0.0}]
    )
    allocation = ThrustAllocator(vessel).allocate((9.0, 9.0, 0.0, 0.0, 0.0, 0.0))
    assert allocation.command == pytest.approx([1.0, math.pi / 4], abs=1e-9)
    assert allocation.unreachable[:2] == pytest.approx([9.0 - 10.0 / math.sqrt(2.0)] * 2, abs=1e-6)


@pytest.mark.parametrize(("x", "y"), [(20.0, 5.0), (-10.0, 2.0), (5.0, 20.0), (-5.0, -20.0), (0.0, 3.0)])
def test_an_azimuth_with_stops_stays_between_them(x, y):
    """Within 40 degrees to either side, ahead and astern."""
    limits = {"thrust_forward": 30.0, "thrust_reverse": 20.0, "angle_limit_deg": 40.0}
    vessel = vehicle_with(azimuths=[{"position": (0.0, 0.0, 0.0)} | limits])
    allocation = ThrustAllocator(vessel).allocate((x, y, 0.0, 0.0, 0.0, 0.0))
    assert abs(allocation.command[1]) <= math.radians(40.0) + 1e-9
    if abs(math.atan2(y, abs(x))) < math.radians(40.0):
        assert allocation.unreachable[:2] == pytest.approx(np.zeros(2), abs=1e-6)
    assert allocation.command[0] * x >= 0.0


def test_commands_are_in_the_actuators_own_units():
    """Shaft speeds in rad/s from unequal gains; the body then gets the wrench."""
    vehicle = twin_screw()
    allocation = ThrustAllocator(vehicle).allocate((20.0, 0.0, 0.0, 0.0, 1.0, 12.0))
    thrusts = np.array([10.0 + 12.0 / 0.8, 10.0 - 12.0 / 0.8])  # port pushes the bow to starboard
    expected = [math.sqrt(thrusts[0] / 0.02), -math.sqrt(-thrusts[1] / 0.011)]
    assert allocation.command == pytest.approx(expected, rel=1e-7)
    assert allocation.action == pytest.approx(np.array(expected) / [60.0, 50.0], rel=1e-7)
    steady = actuator_wrench(vehicle, allocation.command, np.zeros(6))
    assert steady == pytest.approx(allocation.wrench_body, abs=1e-9)


def test_a_dead_band_gives_nothing():
    vehicle = twin_screw(dead_band=10.0)
    allocation = ThrustAllocator(vehicle).allocate((1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert not allocation.wrench_body.any()
    assert allocation.unreachable.tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def test_fins_live_on_speed():
    remus = ThrustAllocator(load_vehicle("remus100"))
    turn = (6.0, 0.0, 0.0, 0.0, 0.0, 2.0)
    assert remus.allocate(turn).command[1:].tolist() == [0.0, 0.0]
    ahead = remus.allocate(turn, surge_speed=1.5)
    assert ahead.command[1] == pytest.approx(2.0 / (-4.168457 * 2.25), rel=1e-6)
    assert ahead.wrench_body[[0, 5]] == pytest.approx([6.0, 2.0], rel=1e-6)
    assert remus.allocate(turn, surge_speed=-1.5).command[1] == pytest.approx(-ahead.command[1], rel=1e-6)


def test_axes_that_are_not_actuated_are_left_free():
    """Thrusters below the origin pitch a BlueROV2 when they push; surge is not given up for that."""
    content = load_vehicle("bluerov2").model_dump()
    for thruster in content["thrusters"][:4]:
        thruster["position"] = (*thruster["position"][:2], 0.0725)
    low = Vehicle.model_validate(content)
    allocation = ThrustAllocator(low).allocate((80.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert allocation.unreachable[[0, 1, 2, 3, 5]] == pytest.approx(np.zeros(5), abs=1e-6)
    assert allocation.wrench_body[4] == pytest.approx(80.0 * 0.0725, rel=1e-6)


def test_the_allocation_matrix_has_a_column_for_each_thrust():
    matrix = everything().allocation_matrix
    assert matrix.shape == (6, 6)
    assert matrix[:, 1] == pytest.approx([0.0, 0.0, -1.0, -0.1, 0.3, 0.0])
    assert matrix[:, 2] == pytest.approx([1.0, 0.0, 0.0, 0.0, 0.1, -0.2])
    assert matrix[:, 3] == pytest.approx([0.0, 1.0, 0.0, -0.1, 0.0, -0.3])


def test_mistakes_are_told():
    with pytest.raises(InvalidInputError, match="no actuators whose force is known"):
        ThrustAllocator(vehicle_with())
    with pytest.raises(InvalidInputError, match="arm"):
        ThrustAllocator(HEAVY, arm=0.0)
    for wrench in (np.zeros(5), np.full(6, math.nan)):
        with pytest.raises(InvalidInputError, match="wrench_body"):
            ThrustAllocator(HEAVY).allocate(wrench)
