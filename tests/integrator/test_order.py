"""The step is of second order in pose and velocity, whatever acts on the body."""

import numpy as np
import pytest
from support.bodies import PlainBody, make_body, random_damping, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order

DURATION = 1.0
COUNTS = np.array([100, 200, 400, 800])

CASES = {
    "free": {},
    "restoring": {"excess_weight": 3.0, "arm": (0.4, -0.3, 2.0)},
    "linear damping": {"linear": True},
    "quadratic damping": {"quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)},
    "full and quadratic damping": {"linear": True, "quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)},
    "current": {"current": (0.5, -0.3, 0.2)},
    "everything": {
        "excess_weight": 3.0,
        "arm": (0.4, -0.3, 2.0),
        "linear": True,
        "quadratic": (3.0, 5.0, 4.0, 1.0, 2.0, 1.5),
        "current": (0.5, -0.3, 0.2),
        "wrench": (4.0, -2.0, 3.0, 1.0, -1.0, 2.0),
    },
}


@pytest.mark.parametrize("merged", [False, True], ids=["single steps", "merged kicks"])
@pytest.mark.parametrize("name", CASES)
def test_order_two(name, merged):
    rng = np.random.default_rng(7)
    case = dict(CASES[name])
    m = random_inertia(rng)
    if case.get("linear") is True:
        case["linear"] = random_damping(rng)
    wrench = np.array(case.pop("wrench", (0.0,) * 6))
    position, q, velocity = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    # Quadratic damping has a kink where a component changes sign; a start with a margin keeps the regression clean.
    velocity = np.sign(velocity) * (0.5 + np.abs(velocity))
    reference = solve(m, position, q, velocity, DURATION, wrench=wrench, **case)
    measured = []
    for count in COUNTS:
        body = make_body(m, DURATION / count, kind=PlainBody, **case)
        body.reset(position, q, velocity)
        if merged:
            body.step(wrench, int(count))
        else:
            for _ in range(count):
                body.step(wrench)
        measured.append(errors(body, reference))
    for kind, series in zip(("position", "attitude", "velocity"), np.array(measured).T, strict=True):
        order = observed_order(DURATION / COUNTS, series)
        assert abs(order - 2.0) < 0.05, f"{name}: {kind} has order {order:.3f}, errors {series}"
