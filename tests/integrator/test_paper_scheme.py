"""The scheme of Xu & Halse: the reduced form against the paper's own, its errata, its limits."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from support import paper
from support.bodies import jacobian_round_off, make_body, random_inertia
from support.fossen import errors
from support.fossen import solve as solve_fossen
from support.order import observed_order

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import Spatial, to_fossen
from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.body import BodyState, spatial_momentum
from dq_marine.integrator.drift import make_drift, make_drift_by
from dq_marine.integrator.drift_report import drift_accepted, equation_met
from dq_marine.integrator.paper_drift import (
    PAPER,
    paper_drift,
    paper_equation,
    paper_increment,
    paper_jacobian,
)
from dq_marine.physics.matrices import angular_first, inertia_term
from dq_marine.report.branch import make_walk

seeds = st.integers(0, 2**32 - 1)
ORIGIN = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def draw(seed, size=0.1, condition=20.0):
    """A random inertia (Fossen's order), increment x = (Phi, Psi), and the momenta (a, b) that it solves."""
    rng = np.random.default_rng(seed)
    m = random_inertia(rng, condition)
    x = size * rng.normal(size=6)
    target = paper.residual(angular_first(m), x, np.zeros(3), np.zeros(3))
    return m, x, target[:3], target[3:]


def complex_step(function, x):
    return np.array([np.imag(function(x + 1e-30j * direction)) / 1e-30 for direction in np.eye(len(x))]).T


# The reduced form


@settings(max_examples=50)
@given(seeds)
@example(23493)
def test_three_and_six_unknowns_have_the_same_solution(seed):
    m, known, a, b = draw(seed, size=0.03)
    h = 0.1
    x, norms = paper.solve(angular_first(m), a, b, h, start=0.9 * known)
    assert norms[-1] < 1e-14
    momentum = Spatial(tuple(2.0 / h * a), tuple(2.0 / h * b))
    pose, carried, report = paper_drift(inertia_term(m), h, ORIGIN, momentum)
    assert equation_met(report.solver)  # the energy may be wrong, as in the example: both solutions err alike
    assert np.allclose(pose.real[1:], x[:3], rtol=0, atol=1e-13)
    assert np.allclose(pose.dual[1:], x[3:], rtol=0, atol=1e-13)
    # Momentum after the step: (2/h) times the equation seen from the other end, f -> f^-1.
    back = paper.residual(angular_first(m), -x, np.zeros(3), np.zeros(3))
    assert np.allclose(np.concatenate(carried), -2.0 / h * back, rtol=0, atol=1e-11)


@settings(max_examples=50)
@given(seeds, st.floats(0.0, 6.0))
def test_the_reduced_jacobian_is_the_complex_step_derivative(seed, log_condition):
    m, x, a, b = draw(seed, condition=10.0**log_condition)
    inertia = inertia_term(m)
    phi = x[:3]

    def reduced(phi):
        c = np.sqrt(1.0 - phi @ phi)
        turn = c * np.eye(3) + paper.skew(phi)
        psi = np.linalg.solve(m[:3, :3], np.linalg.solve(turn, b) - m[:3, 3:] @ phi)
        return paper.residual(angular_first(m), np.concatenate([phi, psi]), a, b)[:3]

    equation = paper_equation(inertia, tuple(phi), tuple(a), tuple(b))
    assert np.allclose(equation.residual, reduced(phi), atol=1e-9 * np.abs(m).max())
    own = np.reshape(paper_jacobian(inertia, equation), (3, 3))
    expected = complex_step(reduced, phi)
    assert np.abs(own - expected).max() <= jacobian_round_off(10.0**log_condition) * np.abs(expected).max()


@given(seeds)
def test_the_increment_is_a_unit_dual_quaternion(seed):
    m, x, a, b = draw(seed)
    f = paper_increment(paper_equation(inertia_term(m), tuple(x[:3]), tuple(a), tuple(b)))
    assert np.dot(f.real, f.real) == pytest.approx(1.0, abs=1e-15)
    assert np.dot(f.real, f.dual) == pytest.approx(0.0, abs=1e-12)


@settings(max_examples=10)
@given(seeds)
def test_spatial_momentum_is_exact(seed):
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng), 0.02, scheme="paper")
    body.reset(velocity_body=0.5 * rng.normal(size=6))
    before = body.spatial_momentum
    body.step(steps=2000)
    reach = 1.0 + np.linalg.norm(body.position_ned)
    assert np.abs(body.spatial_momentum - before).max() < 1e-11 * reach * np.linalg.norm(before)


# Errata: each test fails with the printed form


@settings(max_examples=50)
@given(seeds)
def test_erratum_jacobian_lost_terms(seed):
    """dA/dPsi: the paper lacks S(Psi) M22 - S(M22 Psi), which vanish only for M22 = m 1."""
    m, x, a, b = draw(seed)
    m = angular_first(m)
    expected = complex_step(lambda x: paper.residual(m, x, a, b), x)
    scale = np.abs(expected).max()
    assert np.abs(paper.jacobian(m, x) - expected).max() < 1e-12 * scale
    printed = paper.jacobian(m, x, lost=lambda m, x: np.zeros((3, 3)))
    assert np.abs(printed - expected).max() > 1e-5 * scale
    isotropic = m.copy()
    isotropic[3:, 3:] = 7.0 * np.eye(3)
    assert np.abs(paper.lost_terms(isotropic, x)).max() < 1e-14


@settings(max_examples=50)
@given(seeds)
def test_erratum_gradient_of_the_dual_scalar(seed):
    """d(-Psi.Phi/c)/dPhi: the first term's sign is wrong in print, for every body."""
    rng = np.random.default_rng(seed)
    phi, psi = 0.2 * rng.normal(size=(2, 3))

    def f0(phi):
        return -(psi @ phi) / np.sqrt(1.0 - phi @ phi)

    expected = np.array([np.imag(f0(phi + 1e-30j * d)) / 1e-30 for d in np.eye(3)])
    assert np.allclose(paper.f0_gradient_corrected(phi, psi), expected, rtol=1e-13, atol=1e-15)
    gap = np.abs(paper.f0_gradient_printed(phi, psi) - expected).max()
    assert gap > 1e-3 * np.linalg.norm(np.cross(phi, np.cross(phi, psi)))


@settings(max_examples=20)
@given(seeds)
def test_the_simplified_jacobian_about_the_centre_of_mass(seed):
    rng = np.random.default_rng(seed)
    m = np.diag([0.0, 0.0, 0.0, 5.0, 5.0, 5.0])
    m[:3, :3] = random_inertia(rng)[:3, :3]
    x, a, b = 0.1 * rng.normal(size=6), np.zeros(3), np.zeros(3)
    expected = complex_step(lambda x: paper.residual(m, x, a, b), x)
    assert np.allclose(paper.jacobian_about_com(m, x), expected, atol=1e-12)
    assert np.allclose(paper.jacobian(m, x), expected, atol=1e-12)


def naive_run(m, h, count, wrench, velocity, *, start_kick, node):
    """A forced run by the paper's equations, its start and its velocity retrieval chosen by the flags.

    Returns the pose after `count` steps and the momentum that is called the node's.
    """
    inertia = inertia_term(m)
    force = np.concatenate([wrench[3:], wrench[:3]])
    mu = angular_first(m) @ np.concatenate([velocity[3:], velocity[:3]])
    mu = mu + 0.5 * h * force if start_kick else mu  # (2/h) [A; B] of the first step
    pose = ORIGIN
    for step in range(count):
        if step:
            mu = mu + h * force
        state = Spatial(tuple(mu[:3]), tuple(mu[3:]))
        pose, carried, _ = paper_drift(inertia, h, pose, state)
        mu = np.concatenate(carried)
    mu = mu + h * force  # (2/h) [A; B] of the step that starts at this node: after the full kick
    return pose, mu - 0.5 * h * force if node else mu


@pytest.mark.parametrize("flaw", ["none", "start", "node"])
def test_errata_start_and_node_velocity(flaw):
    """First order: the pose without the half kick at the start, the velocity without taking it off at the node."""
    rng = np.random.default_rng(1)
    m, wrench, velocity = random_inertia(rng, 5.0), rng.normal(size=6), 0.3 * rng.normal(size=6)
    q0 = np.array([1.0, 0.0, 0.0, 0.0])
    _, rotation, velocity_end = solve_fossen(m, np.zeros(3), q0, velocity, 1.0, wrench=wrench)
    counts, measured = np.array([40, 80, 160]), []
    for count in counts:
        pose, mu = naive_run(
            m, 1.0 / count, int(count), wrench, velocity, start_kick=flaw != "start", node=flaw != "node"
        )
        own = Rotation.from_quat(np.roll(pose.real, -1)).as_matrix()
        chi = np.linalg.solve(angular_first(m), mu)
        measured.append(
            (
                Rotation.from_matrix(rotation.T @ own).magnitude(),
                np.linalg.norm(np.concatenate([chi[3:], chi[:3]]) - velocity_end),
            )
        )
    attitude, speed = (observed_order(1.0 / counts, series) for series in np.array(measured).T)
    assert attitude == pytest.approx(1.0 if flaw == "start" else 2.0, abs=0.1)
    assert speed == pytest.approx(2.0 if flaw == "none" else 1.0, abs=0.1)


def test_erratum_sign_of_the_potential():
    """delta(h sum -V) = -2h tau.eta: with the printed + the body would fall up."""
    body = make_body(np.eye(6), 0.01, excess_weight=1.0, scheme="paper")
    body.step(steps=100)
    assert body.position_ned[2] == pytest.approx(0.5, rel=1e-12)


def test_erratum_increment_limit_is_90_degrees():
    """sin(step angle) = h omega: exact up to h omega = 1, no solution beyond."""
    h = 0.02
    for fraction in (0.1, 0.5, 0.9, 0.99):
        body = make_body(np.diag([1.0, 1.0, 1.0, 2.0, 3.0, 4.0]), h, scheme="paper")
        body.reset(velocity_body=(0.0, 0.0, 0.0, 0.0, 0.0, fraction / h))
        q = pose_after_one_paper_step(body)
        step_angle = 2.0 * np.arctan2(q[3], q[0])
        assert np.sin(step_angle) == pytest.approx(fraction, abs=1e-13)
        assert step_angle < np.pi / 2
    beyond = make_body(np.diag([1.0, 1.0, 1.0, 2.0, 3.0, 4.0]), h, scheme="paper")
    beyond.reset(velocity_body=(0.0, 0.0, 0.0, 0.0, 0.0, 1.01 / h))
    _, _, report = paper_drift(beyond.parameters.inertia, h, *beyond.state[:2])
    assert not drift_accepted(report)
    beyond.step()  # the fallback splits it, and each piece is within the limit
    assert beyond.fallback_steps == 1


def pose_after_one_paper_step(body):
    inertia, h, state = body.parameters.inertia, body.step_size, body.state[:2]
    pose, _, report = paper_drift(inertia, h, *state)
    if not drift_accepted(report):  # near the limit Newton is slow, and the solution is followed from rest
        pose, _, report = make_drift_by(PAPER, make_walk(PAPER))(inertia, h, *state)
    assert drift_accepted(report)
    return pose.real


def test_a_spin_beyond_every_split_is_refused_by_name():
    body = make_body(np.diag([1.0, 1.0, 1.0, 2.0, 3.0, 4.0]), 0.02, scheme="paper")
    body.reset(velocity_body=(0.0, 0.0, 0.0, 0.0, 0.0, 320.0 / 0.02))
    before = body.get_state()
    with pytest.raises(StepNotSolvableError) as caught:
        body.step()
    assert np.array_equal(body.get_state(), before)
    assert caught.value.step_times_spin == pytest.approx(320.0)
    assert caught.value.admissible_step is not None


def test_erratum_energy_is_bounded_not_exact():
    rng = np.random.default_rng(3)
    body = make_body(random_inertia(rng), 0.05, scheme="paper")
    body.reset(velocity_body=0.5 * rng.normal(size=6))
    energy, spread = body.kinetic_energy, []
    for _ in range(200):
        body.step(steps=50)
        spread.append(body.kinetic_energy / energy - 1.0)
    assert 1e-6 < np.abs(spread).max() < 0.05
    assert abs(np.mean(spread[150:]) - np.mean(spread[:50])) < 0.3 * np.ptp(spread)


def test_erratum_a_regular_but_indefinite_inertia_is_no_inertia():
    """Det M != 0 does not suffice: the step is refused on an indefinite M."""
    m = np.diag([1.0, 1.0, 1.0, -1.0, 1.0, 2.0])
    momentum = Spatial((0.1, 0.0, 0.0), (0.1, 0.0, 0.0))
    _, _, report = paper_drift(inertia_term(m), 0.1, ORIGIN, momentum)
    assert not drift_accepted(report)


def iterations_to_round_off(size):
    """Median over bodies of the Newton iterations that bring the six unknowns to 1e-15."""
    counts = []
    for seed in range(20):
        m, x, _, _ = draw(seed)
        x = size * x / np.linalg.norm(x)
        m = angular_first(m)
        target = paper.residual(m, x, np.zeros(3), np.zeros(3))
        _, norms = paper.solve(m, target[:3], target[3:], 0.1)
        counts.append(next((i for i, norm in enumerate(norms) if norm < 2e-15), 99))
    return np.median(counts)


def test_erratum_three_iterations_suffice_only_for_small_steps():
    assert iterations_to_round_off(0.05) <= 3
    assert iterations_to_round_off(0.3) > 3


# Why it is not the default


def test_the_paper_scheme_is_not_galilean_invariant_and_the_default_is():
    """A body moving along its spin axis: relative spin error h^2 m v^2/(4 J), for the paper's scheme alone."""
    mass, inertia, spin, speed, h = 30.0, 0.18, 0.5, 0.5, 0.02
    m = np.diag([mass] * 3 + [inertia, 3.45, 3.45])
    errors_by_scheme = {}
    for scheme in ("paper", "midpoint"):
        turned = []
        for v in (0.0, speed):
            body = make_body(m, h, scheme=scheme)
            body.reset(velocity_body=(v, 0.0, 0.0, spin, 0.0, 0.0))
            body.step(steps=100)
            turned.append(2.0 * np.arctan2(body.quaternion_body_to_ned[1], body.quaternion_body_to_ned[0]))
        errors_by_scheme[scheme] = turned[1] / turned[0] - 1.0
    expected = h**2 * mass * speed**2 / (4.0 * inertia)
    assert abs(errors_by_scheme["paper"]) == pytest.approx(expected, rel=0.05)
    assert abs(errors_by_scheme["midpoint"]) < 1e-13


@pytest.mark.parametrize("scheme", ["paper", "midpoint"])
def test_both_schemes_are_of_second_order(scheme):
    rng = np.random.default_rng(8)
    case = {"excess_weight": 2.0, "arm": (0.1, 0.2, 1.0), "quadratic": np.ones(6), "current": (0.3, 0.1, 0.0)}
    m, velocity, wrench = random_inertia(rng), 0.5 + 0.3 * rng.uniform(size=6), rng.normal(size=6)
    reference = solve_fossen(m, np.zeros(3), (1.0, 0.0, 0.0, 0.0), velocity, 1.0, wrench=wrench, **case)
    counts, measured = np.array([100, 200, 400]), []
    for count in counts:
        body = make_body(m, 1.0 / count, scheme=scheme, **case)
        body.reset(velocity_body=velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    for series in np.array(measured).T:
        assert observed_order(1.0 / counts, series) == pytest.approx(2.0, abs=0.05)


def test_make_drift_is_what_the_scene_uses():
    """The drift of a scheme is determined by its five functions."""
    again = make_drift(PAPER)
    m, _, a, b = draw(5)
    momentum = Spatial(tuple(20.0 * a), tuple(20.0 * b))
    assert again(inertia_term(m), 0.1, ORIGIN, momentum) == paper_drift(
        inertia_term(m), 0.1, ORIGIN, momentum
    )
    state = BodyState(*again(inertia_term(m), 0.1, ORIGIN, momentum)[:2])
    before = to_fossen(spatial_momentum(BodyState(ORIGIN, momentum)))
    assert np.allclose(to_fossen(spatial_momentum(state)), before, atol=1e-12)
