"""What free motion keeps: spatial momentum, energy within bounds, the pose's unit constraints, reversibility."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import PlainBody, make_body, random_inertia, random_quaternion

FREE = np.zeros(6)


def start(rng, body):
    body.reset(rng.normal(size=3), random_quaternion(rng), rng.normal(size=6))


@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_spatial_momentum_and_energy_over_1e5_steps(seed):
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng, condition=50.0), 0.02)
    start(rng, body)
    momentum, energy = body.spatial_momentum, body.kinetic_energy
    spread = []
    for _ in range(100):
        body.step(FREE, 1000)
        spread.append(body.kinetic_energy / energy - 1.0)
        # The angular part is about the world origin, from which a free body drifts away.
        reach = np.array([1.0] * 3 + [1.0 + np.linalg.norm(body.position_ned)] * 3)
        deviation = np.abs(body.spatial_momentum - momentum) / (np.linalg.norm(momentum) * reach)
        assert deviation.max() < 1e-11
    assert np.abs(spread).max() < 0.05
    # No drift: the error's mean over the last fifth is that over the first.
    assert abs(np.mean(spread[80:]) - np.mean(spread[:20])) < 0.01


def test_energy_error_is_of_second_order():
    rng = np.random.default_rng(3)
    m, q, velocity = random_inertia(rng), random_quaternion(rng), rng.normal(size=6)
    worst = []
    for h in (0.02, 0.01):
        body = make_body(m, h)
        body.reset((0.0, 0.0, 0.0), q, velocity)
        energy = body.kinetic_energy
        deviation = 0.0
        for _ in range(int(20.0 / h / 10)):
            body.step(FREE, 10)
            deviation = max(deviation, abs(body.kinetic_energy / energy - 1.0))
        worst.append(deviation)
    assert 3.5 < worst[0] / worst[1] < 4.5


def test_unit_constraints_over_1e6_steps():
    rng = np.random.default_rng(11)
    body = make_body(random_inertia(rng), 0.02)
    start(rng, body)
    body.step(FREE, 1_000_000)
    real, dual = body.pose_body_to_ned[:4], body.pose_body_to_ned[4:]
    assert abs(real @ real - 1.0) < 1e-14
    assert abs(real @ dual) < 1e-14 * max(1.0, np.linalg.norm(dual))


@settings(max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_reversing_the_velocity_returns_to_the_start(seed):
    """The step is symmetric: with the velocity reversed, the body retraces its way.

    5 s only: bodies with general M under gravity move chaotically, and 20 s amplify round-off by up to 1e9.
    """
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng), 0.01, excess_weight=1.0, arm=(0.1, 0.2, 1.0), kind=PlainBody)
    start(rng, body)
    position, q = body.position_ned, body.quaternion_body_to_ned
    body.step(FREE, 500)
    body.reset(body.position_ned, body.quaternion_body_to_ned, -body.velocity_body)
    body.step(FREE, 500)
    assert np.linalg.norm(body.position_ned - position) < 1e-10
    assert min(np.linalg.norm(body.quaternion_body_to_ned - s * q) for s in (1, -1)) < 1e-10


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_world_frame_is_arbitrary(seed):
    """Turning and shifting the world turns and shifts the free trajectory."""
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(seed)
    m = random_inertia(rng)
    position, q, velocity = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    turn, shift = Rotation.from_quat(np.roll(random_quaternion(rng), -1)), rng.normal(size=3)
    body, turned = make_body(m, 0.02), make_body(m, 0.02)
    body.reset(position, q, velocity)
    turned_q = np.roll((turn * Rotation.from_quat(np.roll(q, -1))).as_quat(), 1)
    turned.reset(turn.apply(position) + shift, turned_q, velocity)
    for _ in range(3):
        body.step(FREE, 50)
        turned.step(FREE, 50)
        assert np.allclose(turned.position_ned, turn.apply(body.position_ned) + shift, atol=1e-10)
        assert np.allclose(turned.velocity_body, body.velocity_body, atol=1e-10)


def test_reference_point_is_arbitrary():
    """One body described about two points moves the same, to the scheme's order."""
    rng = np.random.default_rng(5)
    m, offset, velocity = random_inertia(rng, 5.0), np.array([0.2, -0.1, 0.3]), rng.normal(size=6)
    s = np.array([[0.0, -offset[2], offset[1]], [offset[2], 0.0, -offset[0]], [-offset[1], offset[0], 0.0]])
    # nu at the origin = H nu at the point origin + offset  (H of Fossen 2021, ch. 3, read backwards)
    h = np.block([[np.eye(3), s], [np.zeros((3, 3)), np.eye(3)]])
    gaps = []
    for step in (0.01, 0.005):
        at_origin, at_point = make_body(m, step), make_body(h.T @ m @ h, step)
        at_origin.reset(velocity_body=h @ velocity)
        at_point.reset(position_ned=offset, velocity_body=velocity)
        count = round(1.0 / step)
        at_origin.step(FREE, count)
        at_point.step(FREE, count)
        assert np.allclose(at_origin.spatial_momentum, at_point.spatial_momentum, atol=1e-12)
        gaps.append(np.linalg.norm(at_origin.quaternion_body_to_ned - at_point.quaternion_body_to_ned))
    assert gaps[0] < 1e-3
    assert 3.0 < gaps[0] / gaps[1] < 5.0


@pytest.mark.parametrize("h", [0.02, 0.1])
def test_momentum_is_exact_even_where_the_solver_stops_early(h, monkeypatch):
    """Coadjoint transport: one Newton iteration leaves the spatial momentum at round-off all the same."""
    from dq_marine.algebra.spatial import to_fossen
    from dq_marine.integrator import drift as module
    from dq_marine.integrator.body import BodyState, spatial_momentum
    from dq_marine.integrator.midpoint_drift import midpoint_drift

    monkeypatch.setattr(module, "MAX_ITERATIONS", 1)
    rng = np.random.default_rng(2)
    body = make_body(random_inertia(rng), h)
    start(rng, body)
    state = body.state
    before = np.array(to_fossen(spatial_momentum(state)))
    residual = 0.0
    for _ in range(500):
        pose, momentum, report = midpoint_drift(body.parameters.inertia, h, *state[:2])
        state = BodyState(pose, momentum)
        residual = max(residual, report.solver.relative_residual_squared**0.5)
    assert residual > 1e-10  # the solver did stop early
    assert np.abs(np.array(to_fossen(spatial_momentum(state))) - before).max() < 1e-11
