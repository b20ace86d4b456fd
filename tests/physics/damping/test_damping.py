"""Damping: terminal velocity, stiffness, agreement with closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from support.bodies import PlainBody, make_body, random_damping, random_inertia
from support.order import observed_order

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.packing import pack
from dq_marine.integrator.body import kinetic_energy
from dq_marine.physics.damping.build import DampingTerm
from dq_marine.physics.matrices import inertia_term, spatial

M = np.diag([19.86, 20.0, 30.0, 0.4, 0.4, 0.6])
LINEAR = np.diag([13.7, 1.0, 33.0, 0.1, 0.8, 0.1])
QUADRATIC = np.array([141.0, 217.0, 190.0, 1.2, 0.5, 1.5])
SURGE = np.array([40.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_run_up_to_terminal_velocity():
    """M = 19.86, linear 13.7, quadratic 141, 40 N from rest."""
    body = make_body(M, 0.001, linear=LINEAR, quadratic=QUADRATIC)
    body.step(SURGE, 500)
    assert body.velocity_body[0] == pytest.approx(0.46661947845568, abs=1e-6)
    body.step(SURGE, 500)
    assert body.velocity_body[0] == pytest.approx(0.48580458347608, abs=1e-6)


@pytest.mark.parametrize("h", [0.01, 0.1, 1.0, 10.0, 1000.0])
def test_terminal_velocity_is_exact_at_any_step(h):
    # Equal masses along all axes: no Munk moment, whose h v limit the largest steps would break.
    m = np.diag([19.86, 19.86, 19.86, 0.4, 0.4, 0.6])
    body = make_body(m, h, linear=LINEAR, quadratic=QUADRATIC)
    body.step(SURGE, 20_000)
    assert body.velocity_body[0] == pytest.approx(0.4862530975891999, rel=1e-12)


def test_pure_quadratic_run_up():
    """Tanh law: V = 0.53262, v(0.5) = 0.50889, x(0.5) = 0.17186."""
    body = make_body(M, 0.0005, quadratic=QUADRATIC)
    body.step(SURGE, 1000)
    assert body.velocity_body[0] == pytest.approx(0.5088883776189, abs=1e-6)
    assert body.position_ned[0] == pytest.approx(0.1718551619782, abs=1e-6)


@pytest.mark.parametrize("stiffness", 10.0 ** np.arange(-2, 7))
def test_linear_damping_decays_at_any_stiffness(stiffness):
    """The kick is exact: never rings, whatever h lambda."""
    h = 0.1
    body = make_body(np.eye(6), h, linear=stiffness / h * np.eye(6))
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    before = 1.0
    for _ in range(5):
        body.step()
        now = body.velocity_body[0]
        assert 0.0 <= now < before or now == before == 0.0
        before = now
    assert now == pytest.approx(math.exp(-5.0 * stiffness), rel=1e-12, abs=1e-300)


@pytest.mark.parametrize("speed", [1.0, 20.0, 1000.0])
def test_quadratic_damping_at_high_speed(speed):
    """v(t) = v0/(1 + c v0 t/m), from far beyond what an explicit step survives."""
    h, steps = 0.02, 50
    m = np.diag([19.86, 19.86, 19.86, 0.4, 0.4, 0.6])  # no Munk moment: see above
    body = make_body(m, h, quadratic=QUADRATIC)
    body.reset(velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.step(steps=steps)
    exact = speed / (1.0 + QUADRATIC[0] * speed * h * steps / m[0, 0])
    assert body.velocity_body[0] == pytest.approx(exact, rel=0.05)


@settings(max_examples=100)
@given(seed=st.integers(0, 2**32 - 1), magnitude=st.floats(-3.0, 6.0))
def test_a_kick_without_a_wrench_only_takes_energy(seed, magnitude):
    """Whatever the damping matrix, gyroscopic parts included."""
    rng = np.random.default_rng(seed)
    m = random_inertia(rng)
    size = 10.0**magnitude
    damping = DampingTerm(size * random_damping(rng), size * rng.uniform(size=6), m)
    inertia, momentum = inertia_term(m), spatial(rng.normal(size=6))
    energy = kinetic_energy(inertia, momentum)
    for _ in range(5):
        momentum = damping.kick(
            damping.timing(0.05).between, damping.matrices, inertia, momentum, spatial(np.zeros(6))
        )
        assert kinetic_energy(inertia, momentum) <= energy * (1.0 + 1e-12)
        energy = kinetic_energy(inertia, momentum)


@pytest.mark.parametrize("order", [2, 4])
@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_kicks_of_diagonal_and_full_damping_agree(order, seed):
    """A constant D through the quadratic kicks with vanishing coefficients."""
    rng = np.random.default_rng(seed)
    m, velocity, wrench = random_inertia(rng), rng.normal(size=6), rng.normal(size=6)
    diagonal = np.diag(rng.uniform(0.1, 2.0, 6))
    nudged = diagonal.copy()
    nudged[0, 1] = 1e-300  # enough to be called full
    tiny = np.full(6, 1e-300)
    case = {"quadratic": tiny, "order": order, "kind": PlainBody}
    one, other = (make_body(m, 0.05, linear=d, **case) for d in (diagonal, nudged))
    for body in (one, other):
        body.reset(velocity_body=velocity)
        body.step(wrench, 20)
    assert np.allclose(other.velocity_body, one.velocity_body, rtol=0, atol=1e-12)


def kicked(damping, kick, m, duration, momentum, wrench):
    """The momentum after one kick at frozen pose."""
    parameters = damping.timing(duration).between
    return kick(parameters, damping.matrices, inertia_term(m), momentum, wrench)


@settings(max_examples=100)
@given(seed=st.integers(0, 2**32 - 1), magnitude=st.floats(-3.0, 3.0))
def test_the_kick_of_linear_damping_is_exact(seed, magnitude):
    """Against SciPy's matrix exponential of (mu, 1)' = [[-D M^-1, F], [0, 0]] (mu, 1)."""
    rng = np.random.default_rng(seed)
    m, d, h = random_inertia(rng), 10.0**magnitude * random_damping(rng), 0.05
    momentum, wrench = rng.normal(size=6), rng.normal(size=6)
    damping = DampingTerm(d, np.zeros(6), m)
    after = kicked(damping, damping.kick, m, h, spatial(momentum), spatial(wrench))
    generator = np.zeros((7, 7))
    generator[:6, :6], generator[:6, 6] = -d @ np.linalg.inv(m), wrench
    exact = (expm(h * generator) @ np.append(momentum, 1.0))[:6]
    got = np.array([*after.linear, *after.angular])
    assert np.allclose(got, exact, rtol=0, atol=1e-11 * max(1.0, np.abs(exact).max()))


def test_the_accurate_kick_is_of_order_four_locally_five():
    """A single kick with quadratic damping, against DOP853; the default one is of second order."""
    rng = np.random.default_rng(4)
    m, momentum, wrench = random_inertia(rng), rng.uniform(1.0, 2.0, 6), rng.normal(size=6)
    damping = DampingTerm(random_damping(rng), rng.uniform(0.5, 1.0, 6), m)
    inverse = np.linalg.inv(m)

    def rate(_, mu):
        nu = inverse @ mu
        return wrench - damping.linear @ nu - damping.quadratic * np.abs(nu) * nu

    durations = np.array([0.04, 0.02, 0.01])
    for kick, order in ((damping.kick, 3), (damping.accurate_kick, 5)):
        missed = []
        for h in durations:
            exact = solve_ivp(rate, (0.0, h), momentum, method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
            after = kicked(damping, kick, m, h, spatial(momentum), spatial(wrench))
            missed.append(np.linalg.norm([*after.linear, *after.angular] - exact))
        assert observed_order(durations, missed) == pytest.approx(order, abs=0.3)


@pytest.mark.parametrize("stiffness", [1.0, 1e2, 1e4, 1e6])
def test_the_accurate_kick_keeps_the_terminal_velocity_and_is_stable(stiffness):
    """From rest and from far beyond: to F = D(chi) chi, with order 4."""
    for speed in (0.0, 30.0):
        body = make_body(M, 0.1, linear=LINEAR, quadratic=stiffness * QUADRATIC, order=4)
        body.reset(velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
        body.step(SURGE, 400)
        u = body.velocity_body[0]
        assert LINEAR[0, 0] * u + stiffness * QUADRATIC[0] * u * u == pytest.approx(40.0, rel=1e-9)


COUPLED = np.eye(6) + 0.1 * np.ones((6, 6))


@pytest.mark.parametrize(
    ("linear", "quadratic", "numbers"),
    [
        (np.zeros((6, 6)), np.zeros(6), []),
        (np.eye(6), np.zeros(6), [6]),
        (np.zeros((6, 6)), np.ones(6), [12]),
        (COUPLED, np.zeros(6), [36]),
        (COUPLED, np.ones(6), [42]),
    ],
)
def test_as_a_force_it_is_the_cheapest_that_has_all_of_it(linear, quadratic, numbers):
    terms = DampingTerm(linear, quadratic, np.eye(6)).drag
    assert [pack(term.parameters).size for term in terms] == numbers
    nu = np.array([1.0, -2.0, 0.5, 0.3, -0.4, 2.0])
    for term in terms:
        force = term.wrench_at(None, from_fossen(tuple(nu)), 0.0)
        assert np.allclose([*force.linear, *force.angular], -linear @ nu - quadratic * np.abs(nu) * nu)
