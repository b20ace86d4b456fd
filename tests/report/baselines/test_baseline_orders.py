"""Each baseline converges to separately written equations at its order, and to DQVI."""

import numpy as np
import pytest
from flown import BASELINES, flown, make_physics
from support.bodies import random_damping, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order

from dq_marine.report.methods import METHODS

DURATION = 0.5
COUNTS = {1: (100, 200, 400), 2: (50, 100, 200), 4: (10, 15, 20, 30), 8: (3, 4, 5)}
TOLERANCE = {1: 0.08, 2: 0.05, 4: 0.25, 8: 0.6}

FULL = random_inertia(np.random.default_rng(3), 5.0)
DIAGONAL = np.diag([3.0, 5.0, 9.0, 1.0, 2.0, 2.5])
RESTORING = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0), "current": (0.2, -0.1, 0.1)}
DAMPING = {"quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5), "linear": random_damping(np.random.default_rng(7))}
CASES = {
    "free": (FULL, {}),
    "free, diagonal M": (DIAGONAL, {}),
    "restoring and current": (FULL, RESTORING),
    "damping": (FULL, DAMPING),
    "diagonal damping": (DIAGONAL, {"linear": np.diag([1.0, 2.0, 1.5, 0.5, 0.6, 0.7])}),
    "everything": (FULL, RESTORING | DAMPING),
}


def start_and_wrench(damped):
    """A start, and a wrench that keeps the velocities' signs: quadratic damping has a kink at zero."""
    rng = np.random.default_rng(7)
    q, velocity = random_quaternion(rng), 0.5 + 0.5 * rng.uniform(size=6)
    wrench = np.abs(rng.normal(size=6)) * 6.0 if damped else 0.5 * rng.normal(size=6)
    return (np.array([0.3, -0.2, 0.1]), q, velocity), wrench


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("baseline", BASELINES)
def test_order(baseline, name):
    m, terms = CASES[name]
    start, wrench = start_and_wrench("linear" in terms)
    order = METHODS[baseline].order
    reference = solve(m, *start, DURATION, wrench=wrench, rtol=3e-14, **terms)
    counts = np.array(COUNTS[order])
    measured = [
        errors(flown(baseline, make_physics(m, **terms), start, DURATION, count, wrench), reference)
        for count in counts
    ]
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        observed = observed_order(DURATION / counts, series)
        assert observed > order - TOLERANCE[order], f"{kind} has order {observed:.3f}, errors {series}"
        # Where two of the leading terms cancel by chance, the fit sees more than the order.
        assert observed < order + 0.6, f"{kind} has order {observed:.3f}, errors {series}"


@pytest.mark.parametrize("baseline", BASELINES)
def test_the_baselines_and_dqvi_have_the_same_limit(baseline):
    start, wrench = start_and_wrench(damped=False)
    physics = make_physics(FULL, **RESTORING)
    fine = flown("dqvi8", physics, start, DURATION, 12, wrench)
    limit = {1: 0.02, 2: 1e-4, 4: 2e-7, 8: 1e-9}[METHODS[baseline].order]
    body = flown(baseline, physics, start, DURATION, 100, wrench)
    assert np.abs(body.pose_body_to_ned - fine.pose_body_to_ned).max() < limit
    assert np.abs(body.velocity_body - fine.velocity_body).max() < limit


def test_the_decoupled_integrator_is_of_order_two_however_strong_the_coupling():
    """M12 is explicit, but taken for the middle of the step."""
    rng = np.random.default_rng(11)
    m = random_inertia(rng, 30.0)
    start = (np.zeros(3), random_quaternion(rng), rng.normal(size=6))
    reference = solve(m, *start, DURATION, rtol=3e-14)
    counts = np.array([100, 200, 400])
    measured = [
        errors(flown("decoupled_lie", make_physics(m), start, DURATION, count), reference) for count in counts
    ]
    for series in np.array(measured).T:
        assert observed_order(DURATION / counts, series) == pytest.approx(2.0, abs=0.05)
