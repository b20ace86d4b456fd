"""Cases are what they say: their bodies, their forces, their starts, what they keep; and the equations they are in."""

import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from support.bodies import random_damping, random_inertia, random_quaternion
from support.fossen import solve

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.report.case_bodies import SUPPLY_VESSEL_RESTORING, remus_100, supply_vessel
from dq_marine.report.case_forces import Waterplane, waterplane
from dq_marine.report.cases import CASES, THRUST
from dq_marine.report.ode import end_state, make_derivative, start_of
from dq_marine.report.physics import Physics


@pytest.mark.parametrize("name", CASES)
def test_a_case_is_whole(name):
    case = CASES[name]
    assert case.name == name
    assert case.title
    assert case.note.endswith(".")
    m = case.physics.mass_matrix
    assert np.array_equal(m, m.T)
    assert np.linalg.eigvalsh(m).min() > 0.0
    assert np.linalg.norm(case.quaternion) == pytest.approx(1.0, abs=1e-15)
    assert json.loads(json.dumps(case.summary())) == json.loads(json.dumps(case.summary()))
    if case.exact is not None:
        start = case.exact(0.0)
        assert np.allclose(start.position, case.position, rtol=0, atol=1e-15)
        assert np.allclose(start.quaternion, case.quaternion, rtol=0, atol=1e-15)
        assert np.allclose(start.velocity, case.velocity, rtol=0, atol=3e-14)


def test_cases_differ():
    summaries = {json.dumps(case.summary()) for case in CASES.values()}
    assert len(summaries) == len(CASES)


def energy(physics, end):
    """Kinetic and potential energy [J], written apart from the forces."""
    down = Rotation.from_quat(np.roll(end.quaternion, -1)).as_matrix()[2]
    potential = -physics.arm @ down - physics.excess_weight * end.position[2]
    for force in physics.forces:
        heave, roll, pitch, heave_pitch = force.parameters
        z = end.position[2]
        potential += 0.5 * heave * z**2 - heave_pitch * z * down[0]
        potential += 0.5 * (pitch * down[0] ** 2 + roll * down[1] ** 2)
    return 0.5 * end.velocity @ physics.mass_matrix @ end.velocity + potential


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.conservative])
def test_conservative_cases_keep_energy(name):
    case = CASES[name]
    assert not case.physics.assembly().dissipation
    y = start_of(case.physics, case.position, case.quaternion, case.velocity)
    derivative = make_derivative(case.physics, case.wrench)
    solution = solve_ivp(derivative, (0.0, 2.0), y, method="DOP853", rtol=1e-11, atol=1e-12)
    energies = [energy(case.physics, end_state(case.physics, y)) for y in solution.y.T]
    kinetic = 0.5 * case.velocity @ case.physics.mass_matrix @ case.velocity
    assert np.ptp(energies) < 1e-9 * kinetic


def test_a_waterplane_is_linear_restoring_near_level():
    heave, roll, pitch, heave_pitch = SUPPLY_VESSEL_RESTORING
    g = np.zeros((6, 6))
    g[2, 2], g[3, 3], g[4, 4], g[2, 4], g[4, 2] = heave, roll, pitch, heave_pitch, heave_pitch
    eta = 1e-6 * np.array([3.0, -2.0, 1.5, 1.0, -0.7, 0.4])
    pose = pose_from_parts(quaternion_from_euler(*eta[3:]), tuple(eta[:3]))
    wrench = waterplane(Waterplane(*SUPPLY_VESSEL_RESTORING), pose, 0.0)
    expected = -g @ eta
    assert np.allclose(
        [*wrench.linear, *wrench.angular], expected, rtol=0, atol=2e-6 * np.abs(expected).max()
    )


def test_the_ship_rocks_at_the_frequencies_that_its_note_states():
    heave, roll, pitch, heave_pitch = SUPPLY_VESSEL_RESTORING
    g = np.zeros((6, 6))
    g[2, 2], g[3, 3], g[4, 4], g[2, 4], g[4, 2] = heave, roll, pitch, heave_pitch, heave_pitch
    found = np.sqrt(np.sort(np.abs(np.linalg.eigvals(np.linalg.solve(supply_vessel(), g))))[-3:])
    assert found == pytest.approx([0.62, 0.86, 0.99], abs=0.005)
    assert all(f"{value:.2f}" in CASES["ship_restoring"].note for value in found)


def test_the_remus_has_the_growth_rate_that_its_note_states():
    m = remus_100()
    rate = 2.0 * np.sqrt(m[0, 0] * (m[1, 1] - m[0, 0]) / (m[1, 1] * m[5, 5]))
    assert f"{rate:.1f}/s" in CASES["kirchhoff_remus"].note


def test_the_thrust_oscillates_on_all_axes():
    times = np.linspace(0.0, 2.0 * np.pi / 1.5, 50)
    wrenches = [THRUST.function(THRUST.parameters, time) for time in times]
    table = np.array([[*wrench.linear, *wrench.angular] for wrench in wrenches])
    assert np.abs(table.mean(axis=0)).max() < 0.03 * np.abs(table).max()
    assert np.ptp(table, axis=0).min() > 1.0
    assert np.allclose(table[0], [0.0, 30.0, -25.0, -0.4, 0.5, 1.0])


@pytest.mark.parametrize("quadratic", [np.zeros(6), np.array([3.0, 5.0, 4.0, 1.0, 2.0, 1.5])])
def test_the_equations_are_those_of_the_separate_ones(quadratic):
    """With all that they have: full M, damping, restoring, current and wrench."""
    rng = np.random.default_rng(4)
    m, linear = random_inertia(rng, 5.0), random_damping(rng)
    arm, current, wrench = rng.normal(size=3), 0.2 * rng.normal(size=3), 6.0 * np.abs(rng.normal(size=6))
    # All velocities stay positive: |nu| nu has a kink at zero, which no solver takes to full precision.
    start = rng.normal(size=3), random_quaternion(rng), 0.6 + 0.5 * rng.uniform(size=6)
    position, rotation, velocity = solve(
        m, *start, 0.5, excess_weight=1.5, arm=arm, linear=linear, quadratic=quadratic, current=current,
        wrench=wrench, rtol=3e-14,
    )  # fmt: skip
    physics = Physics(m, 1.5, arm, linear, quadratic, current)
    derivative, y = make_derivative(physics, wrench), start_of(physics, *start)
    solution = solve_ivp(derivative, (0.0, 0.5), y, method="DOP853", rtol=3e-14, atol=1e-15)
    end = end_state(physics, solution.y[:, -1])
    own = Rotation.from_quat(np.roll(end.quaternion, -1)).as_matrix()
    assert np.allclose(end.position, position, rtol=0, atol=1e-12)
    assert np.allclose(own, rotation, rtol=0, atol=1e-12)
    assert np.allclose(end.velocity, velocity, rtol=0, atol=1e-12)
