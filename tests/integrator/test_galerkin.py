"""The Galerkin variational integrators: one family with the midpoint scheme, symplectic, of their order, any M."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.bodies import PlainBody, make_body, random_damping, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order

from dq_marine.algebra.dual_quaternion import dual_multiply, pose_from_parts, pose_position
from dq_marine.algebra.frames import pose_relative
from dq_marine.algebra.quaternion import rotate
from dq_marine.algebra.screw import pose_exp, pose_log
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.drift_report import equation_met
from dq_marine.integrator.galerkin_drift import make_galerkin_drift
from dq_marine.integrator.midpoint_drift import midpoint_drift
from dq_marine.physics.matrices import inertia_term

ORIGIN = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
FREE = np.zeros(6)


def spatial(numbers):
    return Spatial(tuple(map(float, numbers[:3])), tuple(map(float, numbers[3:])))


def flat(a):
    return np.array([*a.angular, *a.linear])


def pose_numbers(pose):
    return np.array([*pose.real, *pose.dual])


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1), h=st.floats(0.01, 0.2))
def test_with_one_node_it_is_the_midpoint_scheme(seed, h):
    rng = np.random.default_rng(seed)
    inertia = inertia_term(random_inertia(rng, 50.0))
    momentum = spatial(rng.normal(size=6))
    pose = pose_from_parts(tuple(random_quaternion(rng)), tuple(rng.normal(size=3)))
    mine, carried, report = make_galerkin_drift(1)(inertia, h, pose, momentum)
    midpoint, transported, _ = midpoint_drift(inertia, h, pose, momentum)
    assert equation_met(report.solver)
    assert np.abs(pose_numbers(mine) - pose_numbers(midpoint)).max() < 1e-13
    assert np.abs(flat(carried) - flat(transported)).max() < 1e-13 * (1.0 + np.abs(flat(momentum)).max())


def bracket(a, b):
    """[a, b] of twists, angular part first."""
    return np.concatenate([np.cross(a[:3], b[:3]), np.cross(a[:3], b[3:]) + np.cross(a[3:], b[:3])])


def form(at, first, second):
    """The canonical symplectic form on T*SE(3), trivialised from the left: pairs (variation of the pose, of mu)."""
    (eta1, mu1), (eta2, mu2) = (first[:6], first[6:]), (second[:6], second[6:])
    return mu2 @ eta1 - mu1 @ eta2 + at @ bracket(eta1, eta2)


def tangent(drift, inertia, h, momentum):
    """The derivative of a step, trivialised from the left at both ends, by differences of eighth order; and its end."""
    pose, carried, _ = drift(inertia, h, ORIGIN, spatial(momentum))
    columns = []
    for k in range(12):
        total, size = np.zeros(12), 2e-3 * (1.0 if k < 6 else np.abs(momentum).max())
        for steps, weight in ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280)):
            for sign in (1.0, -1.0):
                moved = np.zeros(12)
                moved[k] = sign * steps * size
                start = pose_exp(spatial(moved[:6]))
                end, changed, _ = drift(inertia, h, start, spatial(momentum + moved[6:]))
                apart = flat(pose_log(pose_relative(pose, end)))
                total += sign * weight / size * np.concatenate([apart, flat(changed) - flat(carried)])
        columns.append(total)
    return np.array(columns).T, flat(carried)


@pytest.mark.parametrize("h", [0.1, 0.4])
@pytest.mark.parametrize("stages", [1, 2, 3, 4])
def test_a_step_is_symplectic(stages, h):
    rng = np.random.default_rng(5)
    inertia = inertia_term(random_inertia(rng, 20.0))
    momentum = rng.normal(size=6)
    derivative, end = tangent(make_galerkin_drift(stages), inertia, h, momentum)
    axes = np.eye(12)
    defects = [
        form(end, derivative[:, i], derivative[:, j]) - form(momentum, axes[i], axes[j])
        for i in range(12)
        for j in range(i)
    ]
    assert np.abs(defects).max() < 2e-11


@pytest.mark.parametrize("stages", [2, 3, 4])
def test_a_body_that_moves_along_its_spin_axis_keeps_its_velocity(stages):
    inertia = inertia_term(np.diag([3.0, 5.0, 5.0, 0.2, 0.7, 0.7]))
    momentum = Spatial((0.2 * 3.0, 0.0, 0.0), (3.0 * 2.0, 0.0, 0.0))
    pose, carried, _ = make_galerkin_drift(stages)(inertia, 0.1, ORIGIN, momentum)
    assert np.allclose(flat(carried), flat(momentum), rtol=0, atol=1e-14)
    assert np.allclose(pose_position(pose), (0.2, 0.0, 0.0), rtol=0, atol=1e-14)
    angle = 2.0 * np.arctan2(pose.real[1], pose.real[0])
    assert angle == pytest.approx(0.3, abs={2: 3e-6, 3: 2e-9, 4: 1e-12}[stages])


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1), decades=st.floats(0.0, 4.0))
@example(seed=3824, decades=4.0)  # four times the step errs by 1e-7, twice the step by 5e-10: the order is 8
def test_any_inertia_agrees_with_equations_written_apart(seed, decades):
    rng = np.random.default_rng(seed)
    m = random_inertia(rng, 10.0**decades)
    q, velocity = random_quaternion(rng), rng.normal(size=6) / 10.0 ** (0.5 * decades)
    body = make_body(m, 0.005, scheme="galerkin", order=8, kind=PlainBody)
    body.reset(np.zeros(3), q, velocity)
    body.step(FREE, 40)
    assert max(errors(body, solve(m, np.zeros(3), q, velocity, 0.2, rtol=3e-14))) < 1e-9


RESTORING = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0), "current": (0.2, -0.1, 0.1)}
CASES = {
    "free": {},
    "restoring, current and wrench": RESTORING,
    "linear damping": {"linear": True},
    "everything": {"linear": True, "quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5), **RESTORING},
}
COUNTS = {4: (10, 14, 20, 28), 6: (6, 8, 11, 15), 8: (4, 5, 6, 7)}
TOLERANCE = {4: 0.1, 6: 0.25, 8: 0.5}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("order", [4, 6, 8])
def test_order(order, name):
    rng = np.random.default_rng(3)
    case = dict(CASES[name])
    m = random_inertia(rng, 5.0)
    q, velocity = random_quaternion(rng), 0.5 + 0.3 * rng.uniform(size=6)
    wrench = np.zeros(6) if name == "free" else 0.5 * rng.normal(size=6)
    duration = 1.5
    if "linear" in case:
        case["linear"] = random_damping(rng, 0.5)
    if "quadratic" in case:
        wrench = np.abs(rng.normal(size=6)) * 6.0  # keeps the velocities' signs: |nu| nu has a kink at zero
        duration = 0.4
    reference = solve(m, np.zeros(3), q, velocity, duration, wrench=wrench, rtol=3e-14, **case)
    counts, measured = np.array(COUNTS[order]), []
    for count in counts:
        body = make_body(m, duration / count, scheme="galerkin", order=order, kind=PlainBody, **case)
        body.reset(np.zeros(3), q, velocity)
        body.step(wrench, int(count))
        assert body.fallback_steps == 0
        measured.append(errors(body, reference))
    total = (np.array(measured) / measured[0]).max(axis=1)
    assert observed_order(duration / counts, total) == pytest.approx(order, abs=TOLERANCE[order]), measured


@pytest.mark.sweep  # half a minute for each order
@pytest.mark.parametrize("order", [4, 6, 8])
def test_momentum_is_exact_and_energy_has_no_trend_over_1e5_steps(order):
    rng = np.random.default_rng(6)
    body = make_body(random_inertia(rng), 0.1, scheme="galerkin", order=order)
    body.reset(velocity_body=0.5 * rng.normal(size=6))
    momentum, energy, spread = body.spatial_momentum, body.kinetic_energy, []
    for _ in range(100):
        body.step(FREE, 1000)
        spread.append(body.kinetic_energy / energy - 1.0)
        reach = 1.0 + np.linalg.norm(body.position_ned)
        assert np.abs(body.spatial_momentum - momentum).max() < 1e-11 * reach * np.linalg.norm(momentum)
    assert body.fallback_steps == 0
    assert np.abs(spread).max() < {4: 1e-4, 6: 1e-6, 8: 2e-8}[order]
    assert abs(np.mean(spread[80:]) - np.mean(spread[:20])) < max(2e-12, 0.5 * np.ptp(spread))


def test_what_a_uniform_field_keeps_of_the_momentum_is_exact():
    rng = np.random.default_rng(8)
    body = make_body(
        random_inertia(rng),
        0.1,
        excess_weight=1.0,
        arm=(0.1, 0.0, -0.3),
        scheme="galerkin",
        order=8,
        kind=PlainBody,
    )
    body.reset(rng.normal(size=3), random_quaternion(rng), 0.3 * rng.normal(size=6))
    start = body.spatial_momentum
    body.step(FREE, 200)
    change = body.spatial_momentum - start
    reach = 1.0 + np.linalg.norm(body.position_ned)
    assert np.abs(change[:2]).max() < 1e-12  # the weight acts downwards
    assert change[2] == pytest.approx(20.0, rel=1e-12)
    assert abs(change[5]) < 1e-11 * reach  # and turns nothing about a vertical line


@pytest.mark.parametrize("order", [4, 8])
def test_time_runs_backwards_and_returns_to_the_start(order):
    rng = np.random.default_rng(9)
    inertia = random_inertia(rng)
    keywords = {"excess_weight": 1.0, "arm": (0.1, 0.0, 0.3), "scheme": "galerkin", "order": order}
    forth = make_body(inertia, 0.05, kind=PlainBody, **keywords)
    back = make_body(inertia, -0.05, kind=PlainBody, **keywords)
    forth.reset(rng.normal(size=3), random_quaternion(rng), 0.3 * rng.normal(size=6))
    start = forth.get_state()
    wrench = rng.normal(size=6)
    forth.step(wrench, 40)
    back.set_state(forth.get_state())
    back.step(wrench, 40)
    assert np.allclose(back.get_state(), start, rtol=0, atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_fine_steps_under_weight_take_as_few_sweeps_as_free_ones(seed):
    """Forces act on the first curve already, where it leads."""
    inertia, steps = random_inertia(np.random.default_rng(seed)), 20
    counts = []
    for forces in ({}, {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0)}):
        body = make_body(inertia, 0.02, scheme="galerkin", order=8, **forces)
        body.reset(velocity_body=(0.5, -0.3, 0.2, 0.4, 0.6, -0.5))
        body.step(FREE, steps)
        counts.append(body.newton_iterations)
    free, forced = counts
    assert free <= forced <= free + steps // 4


def test_a_step_that_sweeps_do_not_solve_is_taken_by_the_fallback_and_counted():
    rng = np.random.default_rng(2)
    body = make_body(random_inertia(rng), 0.5, scheme="galerkin", order=8, kind=PlainBody)
    body.reset(velocity_body=(1.0, 0.5, 0.2, 9.0, 12.0, 7.0))
    momentum = body.spatial_momentum
    body.step(FREE, 3)
    assert body.fallback_steps > 0
    assert np.allclose(body.spatial_momentum, momentum, rtol=1e-11, atol=1e-10)


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e6])
def test_stiff_damping_is_left_to_the_stable_kick(stiffness):
    h = 0.1
    body = make_body(
        np.eye(6), h, linear=stiffness / h * np.eye(6), scheme="galerkin", order=8, kind=PlainBody
    )
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.step(np.array([stiffness, 0.0, 0.0, 0.0, 0.0, 0.0]), 20)
    assert body.fallback_steps == 20
    assert body.velocity_body[0] == pytest.approx(h, rel=1e-9)  # the terminal velocity F/D


def test_a_rotated_start_gives_the_rotated_end_to_round_off():
    rng = np.random.default_rng(4)
    inertia, momentum = inertia_term(random_inertia(rng)), spatial(rng.normal(size=6))
    turn = pose_from_parts(tuple(random_quaternion(rng)), (1.0, -2.0, 3.0))
    drift = make_galerkin_drift(4)
    here, carried, _ = drift(inertia, 0.3, ORIGIN, momentum)
    there, same, _ = drift(inertia, 0.3, turn, momentum)
    assert np.allclose(pose_numbers(dual_multiply(turn, here)), pose_numbers(there), rtol=0, atol=1e-14)
    assert np.allclose(flat(carried), flat(same), rtol=0, atol=1e-14)
    assert np.allclose(rotate(here.real, carried.linear), momentum.linear, rtol=0, atol=1e-14)
