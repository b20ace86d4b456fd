"""The offshore supply vessel against MSS's osv.m, written apart in tests/support/osv.py, in still water and a current.

Where the two must differ they are not compared: motion astern through the water, where the published surge force drives
the vessel, and turning in a current, where the published Coriolis matrix takes the velocity over ground.
"""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from support import osv

from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

STEP, PERIOD = 0.1, 50.0
IDLE = np.zeros(6)
STILL = (1e-12, 0.0)
"""A current of no account, so that all runs share one compiled step."""


def run(command, duration, *, wrench=IDLE, current=STILL):
    """Positions, headings and velocities through the water, a row every 50 s: those of the product and of osv.m."""
    vessel = Scene("osv83", actuation="thrusters", current=(*current, 0.0), step=STEP).stepper()
    mine = []
    for _ in range(round(duration / PERIOD)):
        vessel.actuate(command, round(PERIOD / STEP), wrench)
        yaw, pitch, roll = Rotation.from_quat(vessel.quaternion_body_to_ned, scalar_first=True).as_euler(
            "ZYX"
        )
        assert max(abs(roll), abs(pitch)) < np.radians(3.0)
        mine.append([*vessel.position_ned[:2], yaw, *vessel.velocity_body[[0, 1, 5]]])
    shares = np.array([command[0], command[1], command[2], command[4]])
    thrust = osv.thrust(shares * np.abs(shares), np.array([command[3], command[5]])) + wrench
    theirs = osv.osv_run(thrust, np.arange(PERIOD, duration + 1.0, PERIOD), current)[:, [6, 7, 11, 0, 1, 5]]
    return through_water(np.array(mine), current), through_water(theirs, current)


def through_water(rows, current):
    c, s = np.cos(rows[:, 2]), np.sin(rows[:, 2])
    rows[:, 3] -= c * current[0] + s * current[1]
    rows[:, 4] -= c * current[1] - s * current[0]
    return rows


def test_hoerners_coefficient_and_the_resistance_are_the_published():
    vehicle = load_vehicle("osv83")
    assert vehicle.cross_flow[0].section_drag == pytest.approx(osv.HOERNER, rel=1e-12)
    for speed in (0.3, 1.0, 2.0, 4.0, 7.7):
        assert vehicle.damping.blended[0].alone(speed) == pytest.approx(osv.resistance(speed), rel=1e-6)


@pytest.mark.sweep
def test_600_kn_in_sway():
    """1.787 m/s: in pure sway drag and linear damping are a quadratic equation."""
    mine, theirs = run(IDLE, 600.0, wrench=np.array([0.0, 600e3, 0.0, 0.0, 0.0, 0.0]))
    assert theirs[-1, 4] == pytest.approx(1.787, rel=0.001)
    assert mine[-1, 4] == pytest.approx(theirs[-1, 4], rel=0.01)


@pytest.mark.parametrize(("force", "speed"), [(100e3, 2.277), (1075e3, 7.702)])
def test_thrust_ahead(force, speed):
    """The speeds at which osv.m's resistance is the thrust."""
    assert brentq(lambda u: osv.resistance(u) - force, 0.0, 20.0) == pytest.approx(speed, abs=0.001)
    mine, theirs = run(IDLE, 600.0, wrench=np.array([force, 0.0, 0.0, 0.0, 0.0, 0.0]))
    assert mine[:, 3] == pytest.approx(theirs[:, 3], rel=0.01)
    assert mine[-1, 3] == pytest.approx(speed, rel=0.01)


def test_azimuths_at_20_degrees_to_port():
    """From rest at half the largest shaft speeds: speeds, rate of turn, heading and track."""
    angle = np.radians(-20.0)
    mine, theirs = run(np.array([0.0, 0.0, 0.5, angle, 0.5, angle]), 300.0)
    assert np.linalg.norm(mine[-1, :2] - theirs[-1, :2]) < 0.03 * np.linalg.norm(theirs[-1, :2])
    assert mine[-1, 2] == pytest.approx(theirs[-1, 2], rel=0.03)
    assert mine[1:, 3:] == pytest.approx(theirs[1:, 3:], rel=0.03)


@pytest.mark.parametrize("current", [(-0.8, 0.6), (0.0, -1.0)], ids=["from ahead", "abeam"])
def test_it_drifts_with_a_current_of_1_m_s(current):
    mine, theirs = run(IDLE, 300.0, current=current)
    assert np.linalg.norm(mine[-1, :2] - theirs[-1, :2]) < 0.03 * np.linalg.norm(theirs[-1, :2])
    assert mine[:, 3:5] == pytest.approx(theirs[:, 3:5], abs=0.01)
    assert np.abs(mine[:, 2]).max() < np.radians(
        1.0
    )  # what Munk's moment, which osv.m has over ground, leaves of it
