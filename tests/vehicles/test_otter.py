"""The Otter against its published run, and against its published equations under other commands and in a current."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support import otter
from support.otter import damping_diagonal, inertia_matrices, otter_run, restoring_matrix
from support.sweeps import sweep

from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle

RUN = np.loadtxt(Path(__file__).with_name("otter_turn.csv"), delimiter=",", skiprows=1)
"""t, NED position, Euler angles, velocity, propeller speeds: both propellers stepped to 60 and 40 rad/s at 0."""

PERIOD = 0.1
SURGE, SWAY, YAW = 6, 7, 11


def flown(commands, times, step=0.02, **scene):
    """Return the product's run: positions, Euler angles, velocities and propeller speeds, a row for each time."""
    stepper = Scene("otter", actuation="thrusters", step=step, **scene).stepper()
    stepper.reset()
    substeps = round(PERIOD / step)
    rows = []
    for t in np.arange(0.0, times[-1] + 0.5 * PERIOD, PERIOD):
        if np.abs(times - t).min() < 0.5 * step:
            rows.append(row(stepper))
        stepper.actuate(commands(t), substeps)
    return np.array(rows)


def row(stepper):
    q = stepper.quaternion_body_to_ned
    psi, theta, phi = Rotation.from_quat(q, scalar_first=True).as_euler("ZYX")
    return np.concatenate([stepper.position_ned, [phi, theta, psi], stepper.velocity_body])


def deviations(mine, reference):
    """Largest deviations over the reference's ranges: of surge, sway and yaw rate, and of the position."""
    ranges = np.ptp(reference, axis=0)
    velocities = np.abs(mine - reference)[:, [SURGE, SWAY, YAW]].max(axis=0) / ranges[[SURGE, SWAY, YAW]]
    path = np.linalg.norm(ranges[:2])
    return velocities, np.linalg.norm((mine - reference)[:, :2], axis=1).max() / path


def test_the_published_run():
    mine, reference = flown(lambda t: (60.0, 40.0), RUN[:, 0]), RUN[:, 1:13]
    velocities, position = deviations(mine, reference)
    assert (velocities < 0.01).all()
    assert position < 0.02


def test_the_published_matrices():
    rigid, added = inertia_matrices()
    otter = load_vehicle("otter")
    assert np.allclose(otter.mass_matrix, rigid + added, rtol=1e-6, atol=1e-6)
    assert np.allclose(np.diag(otter.linear_damping), damping_diagonal(), rtol=1e-6)
    assert np.allclose(otter.waterplane_stiffness, restoring_matrix()[2:5, 2:5], rtol=1e-6)


def wandering(t):
    return 60.0 + 25.0 * np.sin(0.7 * t), 45.0 - 35.0 * np.sin(0.4 * t)


def astern(t):
    return -70.0, -50.0


def spinning(t):
    return 50.0, -50.0


STILL, FLOWING = (0.0, 0.0, 0.0), (0.3, -0.4, 0.0)
RUNS = [(commands, current) for commands in (wandering, astern, spinning) for current in (STILL, FLOWING)]


@pytest.mark.parametrize(("commands", "current"), sweep(RUNS, plain=[(spinning, STILL)]))
def test_other_runs_and_a_current(commands, current):
    times = np.arange(0.0, 40.01, 0.5)

    def held(t):
        return commands(PERIOD * np.floor(t / PERIOD + 1e-9))

    reference = otter_run(held, times, current)[:, :12]
    mine = flown(held, times, current=current)
    velocities, position = deviations(mine, reference)
    assert (velocities < 0.01).all()
    assert position < 0.02


def test_a_run_on_mars(monkeypatch):
    """Weight, payload and buoyancy with its gravity; the damping is the file's, which was made with Earth's."""
    mars, damping = 3.72, damping_diagonal()
    monkeypatch.setattr(otter, "GRAVITY", mars)
    monkeypatch.setattr(otter, "damping_diagonal", lambda: damping)
    times = np.arange(0.0, 20.01, 0.5)
    reference = otter_run(astern, times)[:, :12]
    mine = flown(astern, times, gravity=mars)
    velocities, position = deviations(mine, reference)
    assert (velocities < 0.01).all()
    assert position < 0.02
    heave, pitch = 2, 4
    ranges = np.ptp(reference, axis=0)[[heave, pitch]]
    assert (np.abs(mine - reference)[:, [heave, pitch]].max(axis=0) < 0.03 * ranges).all()


@pytest.mark.parametrize(("shaft_speed", "rate_deg_s"), [(50.0, 0.0), (70.0, 2.9), (100.0, 15.0)])
def test_hands_off_it_keeps_its_course_only_as_fast_as_its_file_says(shaft_speed, rate_deg_s):
    """With the Munk moment that MSS's otter.m keeps: from 3 mm/s of drift, for half a minute to two."""
    stepper = Scene("otter", actuation="thrusters", step=0.02).stepper()
    speed = 0.03 * shaft_speed
    stepper.reset(velocity_body=(speed, 0.003, 0.0, 0.0, 0.0, 0.0))
    stepper.actuate([shaft_speed, shaft_speed], round(120.0 / speed / 0.02))
    assert abs(np.degrees(stepper.velocity_body[5])) == pytest.approx(rate_deg_s, abs=0.1)
