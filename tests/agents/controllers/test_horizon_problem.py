"""The programme of model predictive control: LQR where nothing limits it, and the best within limits elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import cholesky
from scipy.optimize import lsq_linear
from support.regulated import regulated

from dq_marine.agents.controllers.actuator_box import ActuatorBox, actuator_box
from dq_marine.agents.controllers.deviation import LinearModel
from dq_marine.agents.controllers.horizon_problem import HorizonProblem
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle

EXACT = {"tolerance": 1e-9, "iterations": 100_000}
NEAR = np.array([0.05, -0.04, 0.03, 0.02, -0.03, 0.1, 0.02, 0.01, -0.02, 0.03, 0.02, -0.05])


def repeated(model, periods):
    return LinearModel(*(np.repeat(one[None], periods, axis=0) for one in model))


def wide(box):
    """The same actuators without limits."""
    return ActuatorBox(box.matrix, np.full_like(box.low, -1e3), np.full_like(box.high, 1e3))


@pytest.mark.parametrize("name", ["bluerov2", "bluerov2_heavy", "rexrov"])
@pytest.mark.parametrize("periods", [1, 7, 20])
def test_without_limits_it_is_the_regulator(name, periods):
    """Bellman's principle: the Riccati matrix is the cost of all that comes after the horizon."""
    model, weights, found = regulated(name)
    box = wide(actuator_box(load_vehicle(name), "wrench"))
    problem = HorizonProblem(weights, found.cost, box, periods, **EXACT)
    plan = problem.solve(repeated(model, periods), np.zeros((periods, 6)), NEAR)
    expected, x = [], NEAR
    for _ in range(periods):
        expected.append(-found.gain @ x)
        x = model.state @ x + model.wrench @ expected[-1]
    scale = np.abs(expected).max(axis=0) + 1e-3 * load_vehicle(name).wrench_limits + 1e-9
    np.testing.assert_allclose(plan.shares @ box.matrix.T / scale, expected / scale, atol=2e-5)
    np.testing.assert_allclose(plan.deviations[-1], x, atol=1e-6)


def test_thrusters_that_can_do_the_wrench_are_the_regulator():
    """Eight thrusters for six axes: of those that make the wrench, the least."""
    model, weights, found = regulated("bluerov2_heavy")
    box = wide(actuator_box(load_vehicle("bluerov2_heavy"), "thrusters"))
    plan = HorizonProblem(weights, found.cost, box, 5, **EXACT).solve(
        repeated(model, 5), np.zeros((5, 6)), NEAR
    )
    wanted = -found.gain @ NEAR
    np.testing.assert_allclose(box.matrix @ plan.shares[0], wanted, atol=1e-4 * np.abs(wanted).max())


def dense_solution(model, weights, cost, box, periods, feedforward, x):
    """The same programme as bounded least squares in the shares alone, by SciPy."""
    rows, right = [], []
    influence, free = np.zeros((12, periods * len(box.low))), x
    root_r = np.sqrt(weights.wrench)
    for k in range(periods):
        own = slice(k * len(box.low), (k + 1) * len(box.low))
        wrench = np.zeros((6, influence.shape[1]))
        wrench[:, own] = box.matrix
        rows.append(root_r[:, None] * wrench)
        right.append(root_r * feedforward[k])
        influence = model.state @ influence + model.wrench @ wrench
        free = model.state @ free - model.wrench @ feedforward[k]
        root = cholesky(cost) if k == periods - 1 else np.diag(np.sqrt(weights.state))
        rows.append(root @ influence)
        right.append(-root @ free)
    low, high = np.tile(box.low, periods), np.tile(box.high, periods)
    found = lsq_linear(np.vstack(rows), np.concatenate(right), (low, high), method="bvls", tol=1e-14)
    return found.x.reshape(periods, -1)


def test_within_limits_it_is_the_best_there_is():
    """Far off, where limits bind, beside a reference that asks for some of them; separately written and solved."""
    model, weights, found = regulated("rexrov")
    box, periods = actuator_box(load_vehicle("rexrov"), "wrench"), 8
    feedforward = np.tile(0.3 * load_vehicle("rexrov").wrench_limits, (periods, 1))
    problem = HorizonProblem(weights, found.cost, box, periods, **EXACT)
    plan = problem.solve(repeated(model, periods), feedforward, 20.0 * NEAR)
    best = dense_solution(model, weights, found.cost, box, periods, feedforward, 20.0 * NEAR)
    assert (np.abs(best) > 0.999).any()
    np.testing.assert_allclose(plan.shares, best, atol=2e-4)


def test_shares_are_within_their_limits_whatever_the_deviation():
    model, weights, found = regulated("bluerov2_heavy")
    box = actuator_box(load_vehicle("bluerov2_heavy"), "thrusters")
    assert (box.low > -1.0).any()  # thrusters push less astern than ahead
    problem = HorizonProblem(weights, found.cost, box, 10)
    random = np.random.default_rng(0)
    for size in (1.0, 100.0):
        plan = problem.solve(repeated(model, 10), np.zeros((10, 6)), size * random.normal(size=12))
        assert plan is not None
        assert (plan.shares >= box.low).all()
        assert (plan.shares <= box.high).all()


def test_a_kept_solver_finds_what_a_new_one_does():
    model, weights, found = regulated("bluerov2_heavy")
    box = actuator_box(load_vehicle("bluerov2_heavy"), "wrench")
    kept = HorizonProblem(weights, found.cost, box, 12, tolerance=1e-7)
    for share in (1.0, -3.0, 0.2):
        models = repeated(LinearModel(model.state, (1.0 + 0.1 * share) * model.wrench), 12)
        new = HorizonProblem(weights, found.cost, box, 12, tolerance=1e-7)
        plans = [one.solve(models, np.full((12, 6), share), share * NEAR) for one in (kept, new)]
        np.testing.assert_allclose(plans[0].shares, plans[1].shares, atol=1e-4)
    again = kept.solve(models, np.full((12, 6), share), share * NEAR)
    assert again.iterations <= plans[1].iterations


def test_what_is_not_solved_in_time_is_no_plan_and_leaves_nothing_behind():
    model, weights, found = regulated("rexrov")
    box = actuator_box(load_vehicle("rexrov"), "wrench")
    problem = HorizonProblem(weights, found.cost, box, 20, iterations=1)
    for _ in range(2):
        assert problem.solve(repeated(model, 20), np.zeros((20, 6)), 20.0 * NEAR) is None


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"periods": 0}, "periods = 0 is below 1; give 1 or more"),
        ({"iterations": 0}, "iterations = 0 is below 1"),
        ({"tolerance": float("nan")}, "tolerance = nan is not finite and above 0"),
        ({"tolerance": 0.0}, "tolerance = 0 is not finite and above 0"),
    ],
)
def test_wrong_numbers_are_refused(keywords, message):
    _, weights, found = regulated("rexrov")
    box = actuator_box(load_vehicle("rexrov"), "wrench")
    with pytest.raises(InvalidInputError, match=message):
        HorizonProblem(weights, found.cost, box, **{"periods": 3, **keywords})


def test_what_is_not_finite_is_refused():
    model, weights, found = regulated("rexrov")
    problem = HorizonProblem(weights, found.cost, actuator_box(load_vehicle("rexrov"), "wrench"), 2)
    with pytest.raises(InvalidInputError, match=r"deviation = .*nan.* is not finite"):
        problem.solve(repeated(model, 2), np.zeros((2, 6)), np.full(12, np.nan))
    with pytest.raises(InvalidInputError, match=r"feedforward\[0\] = .* is not finite"):
        problem.solve(repeated(model, 2), np.full((2, 6), np.inf), NEAR)
