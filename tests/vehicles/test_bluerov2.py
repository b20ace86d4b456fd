"""BlueROV2, Heavy and RexROV with lift: momentum shed at the trailing end; the first two fly straight and level."""

import numpy as np
import pytest
from support.fossen import coriolis

from dq_marine.algebra.attitude import attitude_angles
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

NAMES = ["bluerov2", "bluerov2_heavy"]


def lift(vehicle, nu):
    """What the couplings of a file give."""
    by_magnitude = np.einsum("ijk,j,k->i", vehicle.damping_couplings, nu, np.abs(nu))
    return -by_magnitude - np.einsum("ijk,j,k->i", vehicle.signed_damping_couplings, nu, nu)


def shed(vehicle, nu):
    """-|u| m times the velocity across the flow at the trailing end, at that end (Lighthill 1960)."""
    u, v, w, _, q, r = nu
    length, (_, a22, a33) = vehicle.dimensions.length, np.diag(vehicle.added_mass_matrix)[:3]
    x = -0.5 * np.sign(u) * length
    side, down = -abs(u) * a22 / length * (v + x * r), -abs(u) * a33 / length * (w - x * q)
    return np.array([0.0, side, down, 0.0, -x * down, x * side])


@pytest.mark.parametrize("name", [*NAMES, "rexrov"])
def test_the_lift_is_the_momentum_shed_at_the_trailing_end(name):
    """To the four digits of the file, at any motion, ahead and astern; so it takes energy."""
    vehicle = load_vehicle(name)
    for nu in np.random.default_rng(3).normal(size=(20, 6)):
        assert lift(vehicle, nu) == pytest.approx(shed(vehicle, nu), rel=5e-3, abs=5e-3)
        assert shed(vehicle, nu) @ nu < 0.0


@pytest.mark.parametrize("surge", [1.2, -0.8])
@pytest.mark.parametrize("name", NAMES)
def test_munks_moments_and_lift_leave_what_the_file_states(name, surge):
    """(A33/2 - A11) u w in pitch, -(A22/2 - A11) u v in yaw."""
    vehicle = load_vehicle(name)
    added = vehicle.added_mass_matrix
    a11, a22, a33 = np.diag(added)[:3]
    nu = np.array([surge, 0.2, 0.1, 0.0, 0.0, 0.0])
    moment = lift(vehicle, nu) - coriolis(added, nu) @ nu
    assert moment[4] == pytest.approx((0.5 * a33 - a11) * surge * 0.1, rel=1e-3)
    assert moment[5] == pytest.approx(-(0.5 * a22 - a11) * surge * 0.2, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("throttle", [0.25, 0.5, 1.0, -1.0])
@pytest.mark.parametrize("name", NAMES)
def test_it_flies_straight_and_level_hands_off(name, throttle):
    """By its vectored thrusters, ahead and astern, let go aslant and adrift.

    Roll has no linear damping in the Heavy's published set, and so dies as 1/t.
    """
    body = Scene(name, step=0.01, actuation="thrusters").stepper()
    vehicle = load_vehicle(name)
    commands = np.zeros(len(vehicle.channels))
    commands[:4] = throttle * np.array([1.0, 1.0, -1.0, -1.0])
    half = np.radians(2.5)
    across = np.array([np.cos(half), np.sin(half) * 0.7, np.sin(half) * 0.7, 0.0])
    body.reset((0.0, 0.0, 20.0), across / np.linalg.norm(across), (0.0, 0.05, 0.05, 0.0, 0.0, 0.0))
    angles, rates = [], []
    for _ in range(300):
        body.actuate(commands, 10)
        angles.append(attitude_angles(body.quaternion_body_to_ned))
        rates.append(np.abs(body.velocity_body[4:]).max())
    roll, pitch, yaw = np.degrees(np.abs(angles)).T
    assert pitch.max() < 25.0
    assert roll.max() < 25.0
    assert pitch[-1] < 5.0
    assert roll[-1] < 0.5
    assert np.ptp(yaw[-100:]) < 0.1
    assert rates[-1] < 1e-3
    drag = vehicle.linear_damping[0, 0], vehicle.quadratic_damping[0]
    thrust = abs(throttle) ** 2 * np.sqrt(0.5) * 2.0 * (51.5 + 40.2)
    speed = (np.sqrt(drag[0] ** 2 + 4.0 * drag[1] * thrust) - drag[0]) / (2.0 * drag[1])
    assert abs(body.velocity_body[0]) == pytest.approx(speed, rel=0.01)
