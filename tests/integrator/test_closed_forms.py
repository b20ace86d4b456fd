"""Motions with a closed form (classical results; constants to 14 digits from Jacobi elliptic functions)."""

import numpy as np
import pytest
from support.bodies import make_body
from support.order import observed_order

from dq_marine.integrator.drift import make_drift_by
from dq_marine.integrator.drift_report import drift_accepted
from dq_marine.integrator.midpoint_drift import MIDPOINT
from dq_marine.report.branch import make_walk
from dq_marine.vehicles.analysis.lamb import ellipsoid_mass_matrix

REST = np.zeros(6)


@pytest.mark.parametrize("spin", [0.1, 1.0, 60.0, 100.0, 1000.0])
def test_single_axis_spin_solves_the_cubic(spin):
    """(1 + s^2) 2 s = h omega/2 with s = tan(theta/4): the angle of a whole step, followed from rest to any spin."""
    h = 0.02
    body = make_body(np.diag([1.0, 1.0, 1.0, 2.0, 3.0, 4.0]), h)
    body.reset(velocity_body=(0.0, 0.0, 0.0, 0.0, 0.0, spin))
    pose, _, report = make_drift_by(MIDPOINT, make_walk(MIDPOINT))(
        body.parameters.inertia, h, *body.state[:2]
    )
    assert drift_accepted(report)
    q = pose.real
    s = np.tan(0.5 * np.arctan2(q[3], q[0]))
    assert abs((1.0 + s * s) * 2.0 * s / (h * spin / 2.0) - 1.0) < 1e-13


@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
def test_torque_free_top(scheme):
    """J = diag(1, 2, 3): body rates and attitude after 300 s, by order-2 convergence."""
    omega_end = np.array([0.340963036213871, 0.506552988101689, 0.400082264188401])
    q_end = np.array([0.67496667, -0.15865779, -0.47614467, -0.54086408])
    steps, measured = np.array([0.05, 0.025, 0.0125]), []
    for h in steps:
        body = make_body(np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0]), h, scheme=scheme)
        body.reset(velocity_body=(0.0, 0.0, 0.0, np.pi / 10, np.pi / 6, np.pi / 8))
        body.step(REST, round(300.0 / h))
        q = body.quaternion_body_to_ned
        measured.append(
            (
                np.linalg.norm(body.velocity_body[3:] - omega_end),
                min(np.linalg.norm(q - q_end), np.linalg.norm(q + q_end)),
            )
        )
    for series in np.array(measured).T:
        assert abs(observed_order(steps, series) - 2.0) < 0.05
    assert measured[-1][0] < 2e-3
    assert measured[-1][1] < 6e-3


@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
def test_dzhanibekov_flip_interval(scheme):
    """J = diag(1, 2, 3) spun about its middle axis: it flips every 11.578 s."""
    h = 0.002
    body = make_body(np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0]), h, scheme=scheme)
    body.reset(velocity_body=(0.0, 0.0, 0.0, 0.01, 2.0, 0.0))
    flips, sign = [], 1.0
    while len(flips) < 4:
        body.step(REST)
        if body.velocity_body[4] * sign < 0.0:
            flips.append(body.time)
            sign = -sign
    assert np.allclose(np.diff(flips), 11.5780256043045, atol=5e-3)


def spheroid():
    """Neutral spheroid a = 0.5 m, b = 0.125 m in water, with Lamb's added mass."""
    return ellipsoid_mass_matrix(0.5, 0.125, 0.125)


@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
def test_planar_kirchhoff_motion_is_a_pendulum(scheme):
    m = np.diag([35.393878242844494, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877])
    angle = np.pi / 2 - 0.6
    steps, measured = np.array([0.01, 0.005, 0.0025]), []
    for h in steps:
        body = make_body(m, h, scheme=scheme)
        # Momentum P along world x, the body axis pitched up by `angle` from it, not turning.
        q = np.array([np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0])
        p_body = 35.393878242844494 * np.array([np.cos(angle), 0.0, np.sin(angle)])
        velocity = np.concatenate([p_body / np.diag(m)[:3], np.zeros(3)])
        body.reset(quaternion_body_to_ned=q, velocity_body=velocity)
        body.step(REST, round(1.0 / h))
        q = body.quaternion_body_to_ned
        theta = 2.0 * np.arctan2(q[2], q[0])
        x, _, z = body.position_ned
        measured.append((theta, x, z))
    expected = np.array([1.87901600152329, 0.63734700192725, -0.08657478932112])
    error = np.abs(np.array(measured) - expected)
    assert error[-1].max() < 2e-5
    for series in error.T:
        assert abs(observed_order(steps, series) - 2.0) < 0.1


def test_munk_instability_grows_at_its_rate():
    """A spheroid ahead at U turns broadside: small yaw grows as exp(2.3018 U t)."""
    speed, h = 1.0, 0.002
    body = make_body(spheroid(), h)
    body.reset(velocity_body=(speed, 1e-9, 0.0, 0.0, 0.0, 1e-9))
    body.step(REST, round(2.0 / h))
    early = abs(body.velocity_body[5])
    body.step(REST, round(2.0 / h))
    assert np.log(abs(body.velocity_body[5]) / early) / 2.0 == pytest.approx(2.301752703506763, rel=1e-3)


@pytest.mark.parametrize(("share", "stable"), [(0.95, False), (1.05, True)])
def test_spin_stabilises_the_spheroid(share, stable):
    """Axial angular momentum beyond 12.868725401668446 at 1 m/s keeps a spheroid on its course."""
    m = spheroid()
    body = make_body(m, 0.002)
    body.reset(velocity_body=(1.0, 0.0, 0.0, share * 12.868725401668446 / m[3, 3], 1e-6, 0.0))
    largest = 0.0
    for _ in range(100):
        body.step(steps=200)
        largest = max(largest, float(np.abs(body.velocity_body[4:]).max()))
    assert (largest < 1e-4) == stable


@pytest.mark.parametrize(("share", "stable"), [(0.95, False), (1.05, True)])
def test_restoring_stabilises_the_spheroid(share, stable):
    """A righting stiffness beyond 14.81031174198825 N m/rad holds it level at 1 m/s, in the vertical plane."""
    body = make_body(spheroid(), 0.002, arm=(0.0, 0.0, share * 14.81031174198825))
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 1e-6, 0.0))
    largest = 0.0
    for _ in range(100):
        body.step(steps=50)
        largest = max(largest, abs(body.velocity_body[4]))
    assert (largest < 1e-5) == stable


def test_sphere_accelerates_with_its_added_mass():
    """F/(m + m_A), m_A half the displaced mass; not F/m."""
    mass, added, force, h = 10.0, 5.0, 3.0, 0.01
    body = make_body(np.diag([mass + added] * 3 + [0.4] * 3), h)
    body.step((force, 0.0, 0.0, 0.0, 0.0, 0.0), 100)
    assert body.velocity_body[0] == pytest.approx(force / (mass + added), rel=1e-12)
    assert body.position_ned[0] == pytest.approx(0.5 * force / (mass + added), rel=1e-12)


@pytest.mark.parametrize("rate", [0.9688065808574907, 5.959396649418018], ids=["slow", "fast"])
def test_heavy_neutral_top_precesses(rate):
    """W = B, W BG = 2, top-heavy, J = (0.4, 0.4, 0.2), tilt 30 deg, body spin 12: slow or fast precession."""
    tilt, spin, h = np.pi / 6, 12.0, 0.001
    # Top-heavy in NED: the arm points along -z of the body axis that is tilted from "up".
    body = make_body(np.diag([10.0, 10.0, 10.0, 0.4, 0.4, 0.2]), h, arm=(0.0, 0.0, -2.0))
    q = np.array([np.cos(tilt / 2), np.sin(tilt / 2), 0.0, 0.0])
    # Steady precession about the vertical: omega = rate * vertical + relative spin along the body axis.
    down = np.array([0.0, np.sin(tilt), np.cos(tilt)])
    for sense in (1.0, -1.0):
        omega = sense * rate * down
        omega[2] = spin * sense
        body.reset(quaternion_body_to_ned=q, velocity_body=(0.0, 0.0, 0.0, *omega))
        azimuths = []
        for _ in range(10):
            body.step(REST, 50)
            w, x, y, z = body.quaternion_body_to_ned
            axis = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
            assert axis[2] == pytest.approx(np.cos(tilt), abs=2e-4)
            azimuths.append(np.arctan2(axis[1], axis[0]))
        turned = np.unwrap(azimuths)
        assert (turned[-1] - turned[0]) / 0.45 == pytest.approx(sense * rate, rel=1e-3)
