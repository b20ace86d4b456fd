"""Bodies with damping couplings and cross-flow drag: motion, terminal velocity, stiffness, lanes."""

import numpy as np
import pytest
from support.bodies import (
    PlainBody,
    make_body,
    make_damping,
    random_damping,
    random_inertia,
    random_quaternion,
)
from support.fossen import errors, solve, strip_drag
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.physics.matrices import inertia_term, spatial
from dq_marine.simulation.batch import Batch

SWAY_ROW = ("sway", (0.4, -0.7, 0.2, 6))
HEAVE_ROW = ("heave", (0.3, -0.5, 0.3, 5))
STRIPS = (SWAY_ROW, HEAVE_ROW)
BLENDS = ((0, (4.0, 2.5, 2.0)), (5, (1.5, 0.0, 1.0)))
QUADRATIC = np.array([3.0, 5.0, 4.0, 1.0, 2.0, 1.5])
M = np.diag([19.86, 19.86, 19.86, 0.4, 0.4, 0.6])  # no Munk moment, whose h v limit large steps would break
NOTHING = np.zeros((6, 6))


def lift():
    """Forces by surge on sway, heave and their moments, and drag in heave by turning: not symmetric."""
    tensor = np.zeros((6, 6, 6))
    tensor[1, 1, 0], tensor[5, 1, 0], tensor[1, 5, 0], tensor[5, 5, 0] = 2.0, -0.8, -0.5, 0.6
    tensor[4, 2, 0], tensor[2, 4, 4], tensor[0, 1, 1] = 0.7, -0.4, 0.3
    return tensor


CASES = {
    "couplings and strips": {"couplings": lift(), "strips": STRIPS, "quadratic": QUADRATIC},
    "implicit node": {"couplings": lift(), "strips": STRIPS, "quadratic": QUADRATIC, "l_stable": False},
    "order 4": {"couplings": lift(), "strips": STRIPS, "quadratic": QUADRATIC, "order": 4},
    "signed couplings": {"couplings": lift(), "signed": lift(), "quadratic": QUADRATIC},
    "blends": {"couplings": lift(), "blends": BLENDS, "quadratic": QUADRATIC},
    "blends, implicit node": {"blends": BLENDS, "quadratic": QUADRATIC, "l_stable": False},
    "blends, order 4": {"blends": BLENDS, "quadratic": QUADRATIC, "order": 4},
}


@pytest.mark.parametrize("name", CASES)
def test_the_motion_is_fossens_with_the_methods_order(name):
    """No |velocity| passes zero on the way: each would be a kink."""
    case = dict(CASES[name])
    order = case.pop("order", 2)
    l_stable = case.pop("l_stable", True)
    rng = np.random.default_rng(7)
    m, linear = 3.0 * random_inertia(rng, 3.0), random_damping(rng, 0.2)
    position, q = rng.normal(size=3), random_quaternion(rng)
    velocity = np.array([2.0, 1.6, 1.8, 0.8, -1.0, 1.2])
    duration = 0.25
    wrench = 6.0 * np.sign(velocity)
    reference = solve(m, position, q, velocity, duration, linear=linear, wrench=wrench, **case)
    counts = np.array([20, 40, 80]) if order == 2 else np.array([4, 8, 16])
    measured = []
    for count in counts:
        body = make_body(
            m, duration / count, linear=linear, order=order, l_stable=l_stable, kind=PlainBody, **case
        )
        body.reset(position, q, velocity)
        body.step(wrench, int(count))
        measured.append(errors(body, reference))
    assert np.sign(body.velocity_body).tolist() == np.sign(velocity).tolist()
    for series in np.array(measured).T:
        assert observed_order(duration / counts, series) == pytest.approx(order, abs=0.1 * order), measured
        assert series[-1] < (1e-3 if order == 2 else 1e-6)


@pytest.mark.parametrize("h", [0.02, 1.0, 10.0])
@pytest.mark.parametrize(
    ("plane", "axis"),
    sweep([("sway", 1), ("sway", 5), ("heave", 2), ("heave", 4)], plain=[("sway", 1), ("sway", 5)]),
)
def test_strips_have_their_terminal_velocity_at_any_step(plane, axis, h):
    """In pure translation sum c v^2 = F, in pure turning sum c |x|^3 r^2 = N, with strips fore and aft alike."""
    row = (40.0, -0.75, 0.3, 6)
    body = make_body(M, h, strips=[(plane, row)], quadratic=1e-9 * QUADRATIC)
    wrench = np.zeros(6)
    wrench[axis] = 5.0
    body.step(wrench, 3000)
    levers = np.abs(row[1] + row[2] * np.arange(row[3]))
    resistance = row[0] * (row[3] if axis < 3 else (levers**3).sum())
    assert body.velocity_body[axis] == pytest.approx(np.sqrt(5.0 / resistance), rel=1e-7)


@pytest.mark.parametrize("stiffness", sweep([1.0, 1e2, 1e4], plain=[1e2]))
@pytest.mark.parametrize("kick", ["kick", "accurate_kick"])
def test_kicks_settle_exactly_where_wrench_and_drag_balance(kick, stiffness):
    """At frozen pose with h lambda of the stiffness's size, from rest and from far beyond, without ringing on."""
    h = 0.1
    strips = [(plane, (stiffness * row[0], *row[1:])) for plane, row in STRIPS]
    quadratic = stiffness * np.array(
        [30.0, 0.0, 0.0, 0.5, 0.0, 0.0]
    )  # the strips' axes have none of their own
    couplings = stiffness * lift()
    term = make_damping(M, NOTHING, quadratic, couplings, strips)
    wrench = np.array([40.0, 30.0, -20.0, 0.1, -0.3, 0.2])
    for start in (0.0, 30.0):
        momentum = spatial(M @ np.array([start, start, -start, 0.0, 0.1 * start, 0.1 * start]))
        for _ in range(2000):
            momentum = getattr(term, kick)(
                term.timing(h).between, term.matrices, inertia_term(M), momentum, spatial(wrench)
            )
        nu = np.linalg.solve(M, [*momentum.linear, *momentum.angular])
        drag = quadratic * np.abs(nu) * nu + np.einsum("ijk,j,k->i", couplings, nu, np.abs(nu))
        drag = drag + sum(strip_drag(plane, *row, nu) for plane, row in strips)
        assert np.allclose(drag, wrench, rtol=0, atol=1e-8)


@pytest.mark.sweep
@pytest.mark.parametrize("name", CASES)
def test_lanes_have_the_bits_of_a_single_body(name):
    """Each with its own coefficients."""
    rng = np.random.default_rng(11)
    singles = []
    for _ in range(5):
        case = dict(CASES[name])
        case["couplings"] = rng.uniform(0.5, 1.5) * case.get("couplings", lift())
        case["strips"] = [(plane, (rng.uniform(), *row[1:])) for plane, row in case.get("strips", STRIPS)]
        case["blends"] = [(axis, tuple(rng.uniform(0.5, 2.0, 3))) for axis, _ in BLENDS]
        singles.append(make_body(random_inertia(rng), 0.02, linear=random_damping(rng, 0.2), **case))
    first = singles[0]
    batch = Batch(
        first._composition, [single.parameters for single in singles], first.step_size, len(singles)
    )
    velocities = rng.normal(size=(5, 6))
    quaternions = np.array([random_quaternion(rng) for _ in range(5)])
    batch.reset(rng.normal(size=(5, 3)), quaternions, velocities)
    for single, state in zip(singles, batch.get_state(), strict=True):
        single.set_state(state)
    wrenches = 5.0 * rng.normal(size=(5, 6))
    batch.step(wrenches, 20)
    for single, wrench in zip(singles, wrenches, strict=True):
        single.step(wrench, 20)
    assert np.array_equal(batch.get_state(), [single.get_state() for single in singles])
