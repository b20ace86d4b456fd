"""`scheme="runge_kutta"`: orders 4 and 8, what free motion keeps, and steps that are too long for it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import PlainBody, make_body, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.errors import InvalidInputError
from dq_marine.integrator.drift_report import LARGEST_ENERGY_CHANGE
from dq_marine.simulation.scene import Scene

GRAVITY = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0), "current": (0.2, -0.1, 0.1)}
COUNTS = {4: [40, 60, 90], 8: [4, 5, 6, 8]}
"""Steps of the motion, by order."""

OBSERVED = {4: (3.6, 4.4), 8: (7.2, 13.0)}
"""What Verner's method errs by the eighth power of the step is so little that higher powers are seen."""

each_order = pytest.mark.parametrize("order", COUNTS)


def rk_body(mass_matrix, step, kind=None, order=8, **case):
    arguments = {} if kind is None else {"kind": kind}
    return make_body(mass_matrix, step, scheme="runge_kutta", order=order, **arguments, **case)


# Order


@each_order
@pytest.mark.parametrize("name", ["free", "restoring, current and wrench"])
def test_the_order_is_that_asked_for(name, order):
    case = {} if name == "free" else GRAVITY
    rng = np.random.default_rng(3)
    m = random_inertia(rng, 5.0)
    q, velocity = random_quaternion(rng), 0.7 * rng.normal(size=6)
    wrench = 0.5 * rng.normal(size=6) if case else np.zeros(6)
    reference = solve(m, np.zeros(3), q, velocity, 2.0, wrench=wrench, rtol=3e-14, **case)
    counts, measured = np.array(COUNTS[order]), []
    for count in counts:
        body = rk_body(m, 2.0 / count, PlainBody, order, **case)
        body.reset(np.zeros(3), q, velocity)
        body.step(wrench, int(count))
        assert body.fallback_steps == 0
        measured.append(errors(body, reference))
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        observed = observed_order(2.0 / counts, series)
        low, high = OBSERVED[order]
        assert low < observed < high, f"{kind}: {series}"


# What is kept


def test_a_step_that_is_taken_hands_on_no_other_energy():
    """In steps that are too long for half of these motions: what is not left to the fallback has kept its energy."""
    rng = np.random.default_rng(0)
    taken = 0
    for _ in range(20):
        body = rk_body(random_inertia(rng, 1e2), 0.1)
        for _ in range(40):
            body.reset(velocity_body=rng.normal(size=6) * [3.0, 3.0, 3.0, 1.0, 1.0, 1.0])
            before, energy = body.fallback_steps, body.kinetic_energy
            body.step()
            if body.fallback_steps == before:
                taken += 1
                assert body.kinetic_energy == pytest.approx(energy, rel=1.01 * LARGEST_ENERGY_CHANGE)
    assert taken > 200


@each_order
@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1), condition=st.floats(0.0, 4.0))
def test_free_bodies_of_any_inertia_keep_momentum(order, seed, condition):
    """In runs of sixteen steps, in shorter ones, and where steps are left to the fallback."""
    rng = np.random.default_rng(seed)
    body = rk_body(random_inertia(rng, 10.0**condition), 0.05, order=order)
    body.reset(rng.normal(size=3), random_quaternion(rng), rng.normal(size=6))
    momentum = body.spatial_momentum
    for steps in (1, 7, 16, 100):
        body.step(steps=steps)
    reach = 1.0 + np.linalg.norm(body.position_ned)
    assert np.abs(body.spatial_momentum - momentum).max() < 1e-12 * reach * np.linalg.norm(momentum)


@each_order
def test_energy_of_free_motion_is_of_the_methods_order(order):
    rng = np.random.default_rng(6)
    m, velocity, changes = random_inertia(rng), rng.normal(size=6), []
    for step in (0.05, 0.025):
        body = rk_body(m, step, order=order)
        body.reset(velocity_body=velocity)
        energy = body.kinetic_energy
        body.step(steps=round(20.0 / step))
        assert body.fallback_steps == 0
        changes.append(abs(body.kinetic_energy / energy - 1.0))
    assert changes[0] < 0.05
    assert changes[1] < changes[0] / 2.0 ** (order - 1)


@pytest.mark.sweep
def test_a_heavy_top_keeps_momentum_and_energy_to_the_methods_error():
    arm = np.array([0.3, 0.1, -2.0])
    body = rk_body(np.diag([10.0, 10.0, 10.0, 0.4, 0.4, 0.2]), 0.02, arm=arm)
    body.reset(
        (0.0, 0.0, 0.0), (0.9659258262890683, 0.25881904510252074, 0.0, 0.0), (0.2, 0.1, 0, 0, 0, 12.0)
    )
    momentum = body.spatial_momentum
    body.step(steps=2000)
    assert np.abs(body.spatial_momentum - momentum)[[0, 1, 5]].max() < 1e-7 * np.linalg.norm(momentum)
    assert body.fallback_steps == 0


# The same everywhere


@each_order
@pytest.mark.parametrize(
    "case", sweep([{}, GRAVITY], plain=[{}]), ids=lambda case: "forces" if case else "free"
)
def test_plain_python_and_compiled_agree_bit_for_bit(case, order):
    rng = np.random.default_rng(0)
    m, q, velocity = random_inertia(rng), random_quaternion(rng), 0.5 * rng.normal(size=6)
    for wrench in (np.zeros(6), rng.normal(size=6)):
        plain, compiled = (rk_body(m, 0.1, kind, order, **case) for kind in (PlainBody, None))
        for body in (plain, compiled):
            body.reset(np.zeros(3), q, velocity)
            body.step(wrench, 6)
        assert np.array_equal(plain.get_state(), compiled.get_state())


# Steps that are too long


@each_order
def test_free_steps_that_lose_energy_are_taken_by_the_fallback_and_counted(order):
    """A radian and more a step is too much for an explicit method."""
    body = rk_body(np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0]), 1.0, order=order)
    body.reset(velocity_body=(0.3, 0.2, 0.1, 4.0, 6.0, 5.0))
    momentum, energy = body.spatial_momentum, body.kinetic_energy
    body.step(steps=6)
    assert body.fallback_steps == 6
    assert np.abs(body.spatial_momentum - momentum).max() < 1e-11 * np.linalg.norm(momentum)
    assert body.kinetic_energy == pytest.approx(energy, rel=0.05)


@each_order
@pytest.mark.parametrize("rate", sweep(10.0 ** np.arange(1, 9), plain=(1e2, 1e6)))
def test_damping_of_any_stiffness_blows_nothing_up(rate, order):
    """Beyond h lambda of 2.8 or 6.4 steps are Strang's, whose kick is L-stable: the terminal velocity is exact."""
    m = np.diag([10.0, 12.0, 15.0, 1.0, 2.0, 2.5])
    body = rk_body(m, 0.1, PlainBody, order, linear=rate * m)
    body.reset(velocity_body=(1.0, -0.5, 0.3, 0.2, 0.1, -0.3))
    thrust = np.array([50.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    body.step(thrust, 30)
    assert body.velocity_body[0] == pytest.approx(5.0 / rate, rel=1e-5)
    assert np.abs(body.velocity_body[1:]).max() < 1e-5
    assert body.fallback_steps == 0 if rate < 20.0 else body.fallback_steps > 10


@each_order
def test_a_body_at_rest_stays(order):
    body = rk_body(np.eye(6), 0.1, order=order)
    body.step(steps=20)
    assert np.array_equal(body.position_ned, np.zeros(3))
    assert np.array_equal(body.quaternion_body_to_ned, (1.0, 0.0, 0.0, 0.0))
    assert body.fallback_steps == 0


def test_other_orders_are_refused():
    with pytest.raises(
        InvalidInputError, match=r"order = 2, but scheme = 'runge_kutta' has orders 4 and 8 alone; give"
    ):
        Scene(scheme="runge_kutta", order=2)
