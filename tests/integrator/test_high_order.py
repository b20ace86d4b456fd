"""Orders 4, 6 and 8 by composition; time reversal; what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import PlainBody, make_body, random_damping, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, load_vehicle

TOLERANCE = {4: 0.15, 6: 0.3, 8: 0.5}
COUNTS = {4: (20, 40, 80, 160), 6: (12, 18, 27, 40), 8: (4, 5, 7, 9)}
GRAVITY = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0), "current": (0.2, -0.1, 0.1)}


@pytest.mark.parametrize("case", [{}, GRAVITY], ids=["free", "restoring, current and wrench"])
@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
@pytest.mark.parametrize("order", [4, 6, 8])
def test_order(order, scheme, case):
    rng = np.random.default_rng(3)
    m = random_inertia(rng, 5.0)
    q, velocity = random_quaternion(rng), 0.7 * rng.normal(size=6)
    wrench = 0.5 * rng.normal(size=6) if case else np.zeros(6)
    reference = solve(m, np.zeros(3), q, velocity, 2.0, wrench=wrench, rtol=3e-14, **case)
    counts, measured = np.array(COUNTS[order]), []
    for count in counts:
        body = make_body(m, 2.0 / count, scheme=scheme, order=order, kind=PlainBody, **case)
        body.reset(np.zeros(3), q, velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        observed = observed_order(2.0 / counts, series)
        assert observed == pytest.approx(order, abs=TOLERANCE[order]), f"{kind}: {series}"


DAMPED = {
    "linear": {"linear": True},
    "quadratic": {"quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)},
    "everything": {"linear": True, "quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5), **GRAVITY},
}


@pytest.mark.parametrize("name", DAMPED)
@pytest.mark.parametrize("scheme", ["midpoint", "paper"])
def test_order_four_with_damping(scheme, name):
    rng = np.random.default_rng(7)
    case = dict(DAMPED[name])
    m = random_inertia(rng, 5.0)
    if "linear" in case:
        case["linear"] = random_damping(rng)
    q, velocity = random_quaternion(rng), 0.5 + 0.5 * rng.uniform(size=6)
    wrench = np.abs(rng.normal(size=6)) * 6.0  # keeps the velocities' signs: |nu| nu has a kink at zero
    reference = solve(m, np.zeros(3), q, velocity, 0.5, wrench=wrench, rtol=3e-14, **case)
    counts, measured = np.array([20, 30, 45, 68]), []
    for count in counts:
        body = make_body(m, 0.5 / count, scheme=scheme, order=4, kind=PlainBody, **case)
        body.reset(np.zeros(3), q, velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        observed = observed_order(0.5 / counts, series)
        assert observed == pytest.approx(4.0, abs=0.15), f"{kind}: {series}"


@pytest.mark.parametrize("stiffness", 10.0 ** np.arange(-2, 7, 2))
def test_order_four_is_stable_at_any_stiffness(stiffness):
    h = 0.1
    body = make_body(np.eye(6), h, linear=stiffness / h * np.eye(6), order=4, kind=PlainBody)
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.step(steps=20)
    assert abs(body.velocity_body[0]) <= np.exp(-min(20.0 * stiffness, 30.0)) * 1.1 + 1e-12


@pytest.mark.parametrize("order", sweep([4, 6, 8], plain=[8]))
def test_momentum_stays_exact_and_energy_bounded(order):
    rng = np.random.default_rng(6)
    body = make_body(random_inertia(rng), 0.1, order=order)
    body.reset(velocity_body=0.5 * rng.normal(size=6))
    momentum, energy, spread = body.spatial_momentum, body.kinetic_energy, []
    for _ in range(100):
        body.step(steps=100)
        spread.append(body.kinetic_energy / energy - 1.0)
        reach = 1.0 + np.linalg.norm(body.position_ned)
        assert np.abs(body.spatial_momentum - momentum).max() < 1e-11 * reach * np.linalg.norm(momentum)
    assert np.abs(spread).max() < 1e-3
    assert abs(np.mean(spread[80:]) - np.mean(spread[:20])) < max(1e-12, 0.5 * np.ptp(spread))


def undamped():
    content = load_vehicle("bluerov2_heavy").model_dump()
    content["damping"] = {"linear": [0.0] * 6, "quadratic": [0.0] * 6}
    return Vehicle.model_validate(content)


@pytest.mark.parametrize("order", sweep([2, 4, 6, 8], plain=[4]))
@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_time_runs_backwards_and_returns_to_the_start(order, seed):
    rng = np.random.default_rng(seed)
    vehicle, current = undamped(), (0.2, 0.1, 0.0)
    forth = Scene(vehicle, current=current, step=0.05, order=order).stepper()
    back = Scene(vehicle, current=current, step=-0.05, order=order).stepper()
    forth.reset(rng.normal(size=3), random_quaternion(rng), 0.3 * rng.normal(size=6))
    start = forth.get_state()
    wrench = 0.3 * rng.normal(size=6)  # at higher spin a step of 0.05 s is split, forth and back not alike
    forth.step(wrench, 40)  # long motions are unstable and spread round-off
    back.set_state(forth.get_state())
    back.step(wrench, 40)
    assert forth.fallback_steps == back.fallback_steps == 0
    assert np.allclose(back.get_state(), start, rtol=0, atol=1e-9)
    assert back.time == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"order": 6}, r"order = 6.*damping.*order 2 or 4"),
        ({"order": 3}, r"order = 3.*\[2, 4, 6, 8\]"),
        ({"order": "high"}, "order = 'high'"),
        ({"step": -0.02}, r"step = -0.02.*damping.*positive"),
        ({"step": 0.0}, "step = 0"),
    ],
)
def test_what_cannot_hold_is_refused_with_the_reason(arguments, message):
    with pytest.raises(InvalidInputError, match=message):
        Scene(**arguments)
