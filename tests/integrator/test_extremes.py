"""Long runs and extreme bodies: bounded, on the right branch, or refused by name; never a NaN."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.bodies import make_body, random_damping, random_inertia, random_quaternion
from support.sweeps import sweep

from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.step import REFUSALS
from dq_marine.vehicles.analysis.lamb import ellipsoid_mass_matrix

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize(
    ("scheme", "order", "h"),
    sweep(
        [("midpoint", 2, 0.02), ("paper", 2, 0.02), ("galerkin", 8, 0.1), ("gauss", 8, 0.1)],
        plain=[("midpoint", 2, 0.02)],
    ),
)
def test_a_million_free_steps(scheme, order, h):
    """Spatial momentum to 1e-12 relative, energy without drift, both unit constraints to 1e-12."""
    rng = np.random.default_rng(12)
    body = make_body(random_inertia(rng), h, scheme=scheme, order=order)
    velocity = rng.normal(size=6)
    body.reset(rng.normal(size=3), random_quaternion(rng), velocity)
    momentum, energy = body.spatial_momentum, body.kinetic_energy
    spread, worst = [], 0.0
    for _ in range(200):
        body.step(steps=5000)
        spread.append(body.kinetic_energy / energy - 1.0)
        # Angular momentum about the world origin, from which the body drifts away for 20,000 s or more.
        reach = np.linalg.norm(momentum) * (1.0 + np.linalg.norm(body.position_ned))
        worst = max(
            worst, np.abs(body.spatial_momentum[:3] - momentum[:3]).max() / np.linalg.norm(momentum[:3])
        )
        worst = max(worst, np.abs(body.spatial_momentum[3:] - momentum[3:]).max() / reach)
    assert body.steps_taken == 1_000_000
    assert worst < 1e-12
    first, last = np.array(spread[:50]), np.array(spread[150:])
    assert np.abs(spread).max() < 0.01
    assert abs(last.mean() - first.mean()) < max(0.2 * np.ptp(spread), 1e-10)  # high orders: round-off
    real, dual = body.pose_body_to_ned[:4], body.pose_body_to_ned[4:]
    assert abs(real @ real - 1.0) < 1e-12
    assert abs(real @ dual) < 1e-12 * np.linalg.norm(dual)


@pytest.mark.parametrize(("scheme", "order"), [("midpoint", 2), ("paper", 2), ("galerkin", 8), ("gauss", 8)])
def test_momentum_that_is_handed_on_does_not_shrink(scheme, order):
    """Twenty thousand steps one by one, in a plane, where half of an attitude's numbers are zero.

    Lengths of attitudes that are off to one side by a tenth of round-off would take 5e-13 away: round-off that is as
    often up as down is a tenth of that.
    """
    body = make_body(ellipsoid_mass_matrix(0.5, 0.125, 0.125), 0.02, scheme=scheme, order=order)
    body.reset((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.05, 0.0, 0.0, 0.0, 0.0))
    size = np.linalg.norm(body.spatial_momentum)
    for _ in range(20_000):
        body.step()
    assert abs(np.linalg.norm(body.spatial_momentum[:3]) / size - 1.0) < 2e-13


@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
def test_ten_thousand_steps_forth_and_back(scheme):
    """Regular motion (a body of revolution), whose round-off is not amplified: back to the start within 1e-10."""
    m = np.diag([20.0, 30.0, 30.0, 0.3, 2.0, 2.0])
    forth, back = make_body(m, 0.02, scheme=scheme), make_body(m, -0.02, scheme=scheme)
    forth.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), (0.05, 0.02, -0.03, 0.8, 0.1, -0.2))
    start = forth.get_state()
    forth.step(steps=10_000)
    back.set_state(forth.get_state())
    back.step(steps=10_000)
    assert np.abs(back.get_state() - start).max() < 1e-10


@pytest.mark.parametrize("spin", [1.0, 60.0, 100.0, 1000.0])
def test_fast_spins_about_any_axis(spin):
    """H |omega| up to 20 at h = 0.02: solved, momentum exact."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        axis = rng.normal(size=3)
        body = make_body(np.diag([5.0, 5.0, 5.0, 1.0, 2.0, 2.5]), 0.02)
        body.reset(velocity_body=(0.0, 0.0, 0.0, *(spin * axis / np.linalg.norm(axis))))
        before = body.spatial_momentum
        body.step(steps=200)
        assert np.allclose(body.spatial_momentum, before, rtol=0, atol=1e-10 * np.abs(before).max())


@settings(max_examples=60)
@example(533, 5.0, 0.0, 1.0, "midpoint")  # refused for its energy
@given(
    seeds,
    st.floats(0.0, 8.0),
    st.floats(-3.0, 9.0),
    st.floats(-2.0, 2.0),
    st.sampled_from(["midpoint", "paper"]),
)
def test_any_condition_any_mass_any_speed(seed, log_condition, log_mass, log_speed, scheme):
    """Condition up to 1e8, 1 g to 1e9 kg, 1e6 m from the origin: momentum kept, or refused; always finite."""
    rng = np.random.default_rng(seed)
    m = 10.0**log_mass * random_inertia(rng, 10.0**log_condition)
    body = make_body(m, 0.05, scheme=scheme)
    velocity = rng.normal(size=6)
    body.reset(
        1e6 * rng.normal(size=3),
        random_quaternion(rng),
        velocity * 10.0**log_speed / np.linalg.norm(velocity),
    )
    momentum, before = body.spatial_momentum, body.get_state()
    try:
        body.step(steps=20)
    except StepNotSolvableError as error:
        assert np.array_equal(body.get_state(), before)
        assert error.reason in REFUSALS.values()
    assert np.isfinite(body.get_state()).all()
    reach = np.array([1.0] * 3 + [1e7] * 3)
    scale = np.linalg.norm(momentum[:3]) + np.linalg.norm(body.state.momentum.angular)
    assert (np.abs(body.spatial_momentum - momentum) <= 1e-9 * scale * reach).all()


@pytest.mark.sweep
@settings(max_examples=40)
@given(seeds, st.floats(-2.0, 6.0), st.sampled_from([2, 4]))
def test_stiff_damping_with_any_inertia(seed, log_stiffness, order):
    """H lambda from 1e-2 to 1e6: the body comes to rest, or as near as its softest axis lets it."""
    rng = np.random.default_rng(seed)
    m, h = random_inertia(rng), 0.1
    damping = 10.0**log_stiffness / h * random_damping(rng)
    body = make_body(m, h, linear=damping, order=order)
    body.reset(velocity_body=rng.normal(size=6))
    energy = body.kinetic_energy
    body.step(steps=50)
    assert np.isfinite(body.get_state()).all()
    assert body.kinetic_energy < energy
    if log_stiffness > 2.0:
        assert body.kinetic_energy < 1e-12 * energy


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("stiffness", [1e-2, 1.0, 1e3, 1e6])
def test_terminal_velocity_is_exact_on_every_axis(axis, stiffness):
    m, h = np.diag([20.0] * 3 + [2.0] * 3), 0.1
    linear = m * stiffness / h
    body = make_body(m, h, linear=linear, quadratic=np.full(6, 3.0))
    wrench = np.zeros(6)
    wrench[axis] = 5.0
    body.step(wrench, 20_000)
    k, q = linear[axis, axis], 3.0
    exact = 2.0 * 5.0 / (k + np.sqrt(k * k + 4.0 * q * 5.0))
    assert body.velocity_body[axis] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
@pytest.mark.parametrize("mass", [1e-3, 1e3, 1e9])
def test_fast_motion_without_spin_is_no_trouble(scheme, mass):
    """M with six equal eigenvalues: no torque but round-off, which must not be taken for a residual."""
    rng = np.random.default_rng(3)
    basis, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    body = make_body(mass * 0.5 * (basis @ basis.T + (basis @ basis.T).T), 0.2, scheme=scheme)
    velocity = np.array([4.4, -98.9, -14.2, 0.0, 0.0, 0.0])
    body.reset(velocity_body=velocity)
    body.step(steps=500)
    assert body.fallback_steps == 0 or scheme == "paper"  # whose limit is h v = 2 sqrt(J/m) = 2
    assert np.allclose(body.position_ned, 100.0 * velocity[:3], rtol=1e-9)
    assert np.linalg.norm(body.velocity_body[3:]) < 1e-9
