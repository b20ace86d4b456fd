"""The discrete equation of the midpoint-frame drift: its Jacobian, its meaning, its solution."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp
from support.bodies import jacobian_round_off, random_inertia
from support.strategies import poses, vectors

from dq_marine.algebra.dual_quaternion import DualQuaternion, dual_multiply, pose_from_parts, pose_position
from dq_marine.algebra.frames import coadjoint_inverse
from dq_marine.algebra.quaternion import quaternion_dot
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.integrator import midpoint_drift as drift
from dq_marine.integrator.drift import transport_momentum
from dq_marine.physics.matrices import inertia_term

seeds = st.integers(0, 2**32 - 1)


def turn_half(t, gain, a):
    """R a: from the midpoint frame to the frame at the start of the step."""
    return scale(gain, drift.conjugate_unscaled(t, a))


def draw(seed, condition=20.0, size=0.3):
    rng = np.random.default_rng(seed)
    m = random_inertia(rng, condition)
    t, a, b = (tuple(size * rng.normal(size=3)) for _ in range(3))
    return inertia_term(m), t, a, b


@settings(max_examples=50)
@given(seeds, st.floats(0.0, 6.0))
def test_jacobian_is_the_complex_step_derivative(seed, log_condition):
    """Every operation of the residual is analytic, so a complex step is exact to round-off."""
    inertia, t, a, b = draw(seed, 10.0**log_condition)
    equation = drift.drift_equation(inertia, t, a, b)
    jacobian = np.reshape(drift.drift_jacobian(inertia, equation), (3, 3))
    step = 1e-30
    columns = []
    for i in range(3):
        moved = tuple(complex(t[k], step if k == i else 0.0) for k in range(3))
        residual = drift.drift_equation(inertia, moved, a, b).residual
        columns.append(np.imag(residual) / step)
    expected = np.array(columns).T
    assert (
        np.abs(jacobian - expected).max() <= jacobian_round_off(10.0**log_condition) * np.abs(expected).max()
    )


@settings(max_examples=30)
@given(seeds)
def test_solution_is_stationary_in_the_discrete_action(seed):
    """The residual is the constraint force of T_d = (2/h)[2t; y]^T M [2t; y].

    With xi = [2t; y] the kinetic term's momenta are (za, zz) = M xi; (D1)-(D5) say that the half-step transport of
    (za, zz) by r gives the given momenta (a, b): b = R zb with zb = M21 2t + M22 y, and (D5).
    """
    inertia, t, a, b = draw(seed)
    equation = drift.drift_equation(inertia, t, a, b)
    m = np.block(
        [
            [np.reshape(inertia.matrix.angular, (3, 3)), np.reshape(inertia.matrix.angular_linear, (3, 3))],
            [np.reshape(inertia.matrix.linear_angular, (3, 3)), np.reshape(inertia.matrix.linear, (3, 3))],
        ]
    )
    xi = np.concatenate([2.0 * np.array(t), equation.y])
    za, zb = np.split(m @ xi, 2)
    assert np.allclose(za, equation.za, atol=1e-12)
    assert np.allclose(zb, equation.zb, atol=1e-10)
    assert np.allclose(turn_half(t, equation.gain, equation.zb), b, atol=1e-12)


def test_residual_at_high_precision():
    """The float64 residual against the same equation written with rotation matrices in 50 digits."""
    inertia, t, a, b = draw(4)
    mp.dps = 50
    tm, am, bm = (mp.matrix([mp.mpf(c) for c in v]) for v in (t, a, b))

    def s(v):
        return mp.matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

    square = (tm.T * tm)[0]
    turn = ((1 - square) * mp.eye(3) + 2 * tm * tm.T + 2 * s(tm)) / (1 + square)
    m11, m12, m21, m22 = (mp.matrix(np.reshape(block, (3, 3)).tolist()) for block in inertia.matrix)
    zb = turn.T * bm
    y = mp.inverse(m22) * (zb - 2 * m21 * tm)
    za = 2 * m11 * tm + m12 * y
    w = s(y) * zb
    residual = (1 + square) * turn * za + w + s(tm) * w - am
    own = drift.drift_equation(inertia, t, a, b).residual
    assert max(abs(own[i] - residual[i]) for i in range(3)) < 1e-13


@given(seeds)
def test_increment_is_half_turn_translate_half_turn(seed):
    inertia, t, a, b = draw(seed)
    equation = drift.drift_equation(inertia, t, a, b)
    length = np.sqrt(1.0 + np.dot(t, t))
    half = DualQuaternion((1.0 / length, *(c / length for c in t)), (0.0,) * 4)
    shift = DualQuaternion((1.0, 0.0, 0.0, 0.0), (0.0, *equation.y))
    expected = dual_multiply(dual_multiply(half, shift), half)
    increment = drift.pose_increment(equation)
    assert np.allclose(increment.real, expected.real, atol=1e-14)
    assert np.allclose(increment.dual, expected.dual, atol=1e-13)
    assert abs(quaternion_dot(increment.real, increment.real) - 1.0) < 1e-14
    displacement = 2.0 * np.array(turn_half(t, equation.gain, equation.y))
    assert np.allclose(pose_position(increment), displacement, atol=1e-12)


@given(poses, poses, vectors, vectors)
def test_momentum_transport_is_coadjoint(pose, increment, angular, linear):
    """The spatial momentum, coadjoint of the pose, is the same before and after."""
    moved = dual_multiply(pose, increment)
    momentum = Spatial(angular, linear)
    carried = transport_momentum(pose.real, moved.real, pose_position(increment), momentum)
    before, after = (coadjoint_inverse(p, m) for p, m in ((pose, momentum), (moved, carried)))
    assert np.allclose(np.concatenate(after), np.concatenate(before), atol=1e-9)


@settings(max_examples=50)
@given(seeds, st.floats(-4.0, 0.0))
def test_solver_converges_quadratically_to_round_off(seed, log_size):
    inertia, _, a, b = draw(seed, size=10.0**log_size * 0.3)
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    h = 0.1
    momentum = Spatial(tuple(2.0 / h * c for c in a), tuple(2.0 / h * c for c in b))
    _, _, report = drift.midpoint_drift(inertia, h, pose, momentum)
    if report.solver.on_rest_branch:
        assert report.solver.relative_residual_squared < 1e-24
        assert report.solver.iterations <= 8


def test_rest_stays_at_rest():
    inertia, *_ = draw(1)
    pose = pose_from_parts((0.6, 0.0, 0.8, 0.0), (1.0, 2.0, 3.0))
    rest = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    moved, momentum, report = drift.midpoint_drift(inertia, 0.1, pose, rest)
    assert momentum == rest
    assert np.allclose(moved.real, pose.real, atol=1e-16)
    assert np.allclose(pose_position(moved), (1.0, 2.0, 3.0), atol=1e-15)
    assert report.solver.on_rest_branch
    assert report.energy_kept
