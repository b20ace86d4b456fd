"""Tanker and supply vessel: turning circles of ships, straight courses, and where their estimates come from."""

import functools

import numpy as np
import pytest
from support.fossen import coriolis
from support.sweeps import sweep

from dq_marine.manoeuvres import turning_circle
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

MAIN = {"tanker": (246.0, 46.0, 10.0, 92312.4), "supply_vessel": (82.8, 19.2, 6.0, 6207.03)}
"""Length, beam, draft [m] and displaced volume [m^3]."""

A_H, X_H, X_R, L_R, GAMMA = 0.312, -0.464, -0.5, -0.71, 0.5 * (0.395 + 0.640)
"""Of KVLCC2's rudder: Yasukawa and Yoshimura (2015)."""


def hull_derivatives(length, beam, draft, volume):
    """Y_uv, Y_ur, N_uv, N_ur by Clarke et al. (1983), per speed ahead."""
    b_t, b_l, t_l = beam / draft, beam / length, draft / length
    block = volume / (length * beam * draft)
    s = -np.pi * t_l**2 * 0.5 * 1025.0 * length**2
    return s * np.array(
        [
            1.0 + 0.4 * block * b_t,
            length * (-0.5 + 2.2 * b_l - 0.08 * b_t),
            length * (0.5 + 2.4 * t_l),
            length**2 * (0.25 + 0.039 * b_t - 0.56 * b_l),
        ]
    )


def rudder_lift(length, beam, draft):
    """(1/2) rho A_R C_N for the rule's area and an aspect ratio of 1.5, by Fujii's formula."""
    area = draft * length / 100.0 * (1.0 + 25.0 * (beam / length) ** 2)
    return 0.5 * 1025.0 * area * 6.13 * 1.5 / (1.5 + 2.25)


@functools.cache
def circle(name, degrees, side):
    return turning_circle(load_vehicle(name), helm=degrees / 35.0, side=side)


@pytest.mark.parametrize("name", MAIN)
def test_added_mass_and_lift_together_are_those_of_hull_and_rudder(name):
    vehicle, (length, beam, draft, volume) = load_vehicle(name), MAIN[name]
    lift, levers = GAMMA * rudder_lift(length, beam, draft), np.array([1.0, L_R * length])
    rudder = -lift * np.outer([1.0 + A_H, (X_R + A_H * X_H) * length], levers)
    expected = hull_derivatives(length, beam, draft, volume).reshape(2, 2) + rudder
    added, ahead = vehicle.added_mass_matrix, np.eye(6)[0]

    def wrench(nu):
        drag = np.einsum("ij,j->i", vehicle.damping_couplings[:, :, 0] * abs(nu[0]), nu)
        return -coriolis(added, nu) @ nu - drag

    totals = np.column_stack([(wrench(ahead + e) - wrench(ahead - e)) / 2.0 for e in np.eye(6)])
    assert totals[np.ix_([1, 5], [1, 5])] == pytest.approx(expected, rel=2e-4)


@pytest.mark.parametrize("name", MAIN)
def test_the_rudders_force_goes_with_the_square_of_the_speed_and_is_the_rules(name):
    vehicle, (length, beam, draft, _) = load_vehicle(name), MAIN[name]
    (fin,) = vehicle.fins
    assert (fin.limit_deg, fin.rate_limit_deg_s) == (35.0, 2.32)
    full = 1.5**2 * rudder_lift(length, beam, draft) * np.sin(fin.limit) * np.cos(fin.limit)
    force, depth = -(1.0 + A_H) * full, 0.5 * draft
    moment = -(X_R + A_H * X_H) * length * full
    assert fin.limit * np.array(fin.coefficients) == pytest.approx(
        [0.0, force, 0.0, -depth * force, 0.0, moment], rel=1e-3
    )


def test_the_tankers_damping_is_the_published():
    """The diagonal of tanker.mat's Bv, but for surge; heave, roll and pitch have wave radiation besides."""
    vehicle = load_vehicle("tanker")
    at_rest = np.diag(vehicle.damping_at_rest)
    assert at_rest[[1, 5]] == pytest.approx([1.45595e6, 2.95629e10], rel=1e-5)
    assert at_rest[3] == pytest.approx(9.01061e8 + 1.051871e9, rel=1e-6)
    assert vehicle.buoyancy.center[2] == pytest.approx(10.0 - 5.184)
    assert load_vehicle("supply_vessel").buoyancy.center[2] == pytest.approx(6.0 - 3.334)


@pytest.mark.parametrize("degrees", [35.0, 30.0])
@pytest.mark.parametrize("name", sweep(MAIN, plain=["tanker"]))
def test_it_turns_like_a_ship(name, degrees):
    """IMO asks of all ships for 5 lengths of tactical diameter and 4.5 of advance at most (MSC.137(76))."""
    side = "starboard" if degrees == 35.0 else "port"
    turn = circle(name, degrees, side)
    assert 2.0 < turn.tactical_diameter / turn.length < 4.5
    assert 2.0 < turn.advance / turn.length < 4.5
    assert np.degrees(turn.largest_roll) < 15.0
    assert 5.0 < np.degrees(turn.steady.drift_angle) < 30.0
    assert 0.3 < turn.steady.speed / turn.approach_speed < 0.7
    assert turn.course_growth_rate < 0.0


@pytest.mark.parametrize(
    ("name", "speed"), sweep([("tanker", 7.717), ("supply_vessel", 8.28)], plain=[("tanker", 7.717)])
)
def test_it_goes_straight_hands_off(name, speed):
    """At the speed that its propellers hold, from a tenth of a degree of drift and of heel.

    The yaw dies away at the rate of small deviations that the turning circle's approach has measured.
    """
    vehicle = load_vehicle(name)
    body = Scene(vehicle, actuation="thrusters", step=0.05).stepper()
    roll = np.radians(0.1)
    body.reset(
        (0.0, 0.0, vehicle.equilibrium_depth),
        (np.cos(0.5 * roll), np.sin(0.5 * roll), 0.0, 0.0),
        (speed, speed * roll, 0.0, 0.0, 0.0, 0.0),
    )
    ahead = np.array([float("propeller" in channel.name) for channel in vehicle.channels])
    steps = round(20.0 * vehicle.dimensions.length / speed / 0.05)
    rates = []
    for _ in range(4):
        body.actuate(ahead, steps)
        rates.append(abs(body.velocity_body[5]))
    assert body.velocity_body[0] == pytest.approx(speed, rel=1e-3)
    assert rates[-1] < 0.2 * rates[0]
    growth = np.log(rates[-1] / rates[-2]) / (0.05 * steps)
    assert growth == pytest.approx(circle(name, 35.0, "starboard").course_growth_rate, rel=0.02)
    assert abs(body.position_ned[1]) < 0.05 * body.position_ned[0]
