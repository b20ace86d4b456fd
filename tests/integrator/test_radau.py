"""`scheme="gauss"` with damping, by Radau's method: order 7, corners of |nu| nu, stiffness, terminal velocity."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from support.bodies import PlainBody, make_body, random_damping, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.algebra.frames import momentum_bracket, momentum_bracket_slope
from dq_marine.algebra.spatial import Matrix6, Spatial, matrix6_transform
from dq_marine.algebra.stages import Stages
from dq_marine.integrator import radau_sweeps
from dq_marine.integrator.collocation import radau
from dq_marine.integrator.corner import make_corners
from dq_marine.integrator.radau import make_radau_method
from dq_marine.integrator.splitting import crout, splitting
from dq_marine.integrator.sweeps import Ending
from dq_marine.physics.damping.formulas.diagonal import DIAGONAL
from dq_marine.physics.matrices import angular_first, matrix6

GRAVITY = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0), "current": (0.2, -0.1, 0.1)}
QUADRATIC = (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)
STRIPS = (("sway", (2.0, -0.4, 0.2, 5)),)


def damped_body(mass_matrix, step, kind=PlainBody, **case):
    return make_body(mass_matrix, step, scheme="gauss", order=8, kind=kind, **case)


# The method's coefficients


@pytest.mark.parametrize("stages", [1, 2, 3, 4, 5])
def test_coefficients_integrate_polynomials_and_end_with_the_step(stages):
    method = radau(stages)
    a, b, c = np.array(method.matrix), np.array(method.weights), np.array(method.nodes)
    for degree in range(2 * stages - 1):
        assert b @ c**degree == pytest.approx(1.0 / (degree + 1), abs=1e-15)
    for degree in range(stages):
        assert a @ c**degree == pytest.approx(c ** (degree + 1) / (degree + 1), abs=1e-15)
    assert c[-1] == 1.0
    assert np.abs(a[-1] - b).max() < 1e-16
    assert method.order == 2 * stages - 1


@pytest.mark.parametrize("stages", [2, 3, 4, 5])
def test_newton_with_the_triangle_converges_at_any_stiffness(stages):
    """Errors shrink by z (1 - z L)^-1 (A - L) in each iteration, z = -h lambda."""
    method = radau(stages)
    a, lower, split = np.array(method.matrix), np.array(crout(method.matrix)), splitting(method)
    assert np.array(split.together) @ np.diag(split.diagonal) @ np.array(split.apart) == pytest.approx(
        lower, abs=1e-12
    )
    assert np.triu(np.linalg.solve(lower, a)) == pytest.approx(np.linalg.solve(lower, a), abs=1e-14)
    assert np.diag(np.linalg.solve(lower, a)) == pytest.approx(np.ones(stages), abs=1e-14)
    for z in -np.geomspace(1e-3, 1e8, 100):
        shrinking = z * np.linalg.solve(np.eye(stages) - z * lower, a - lower)
        assert np.abs(np.linalg.eigvals(shrinking)).max() < (0.19 if stages == 4 else 0.5)


def test_the_slope_of_kirchhoffs_equations_is_their_derivative():
    rng = np.random.default_rng(1)
    m = angular_first(random_inertia(rng))

    def rate(x):
        y = m @ x
        bracket = momentum_bracket(Spatial(tuple(x[:3]), tuple(x[3:])), Spatial(tuple(y[:3]), tuple(y[3:])))
        return np.concatenate(bracket)

    x, d = rng.normal(size=6), rng.normal(size=6)
    y = m @ x
    slope = momentum_bracket_slope(
        Matrix6(*matrix6(m)), Spatial(tuple(x[:3]), tuple(x[3:])), Spatial(tuple(y[:3]), tuple(y[3:]))
    )
    got = np.concatenate(matrix6_transform(slope, Spatial(tuple(d[:3]), tuple(d[3:]))))
    assert got == pytest.approx(
        (rate(x + d) - rate(x - d)) / 2.0, abs=1e-12
    )  # quadratic: differences are exact


# Corners


def corner_of(velocity, c=3.0):
    """What is missing in the quadrature of -c |v| v to each stage, in surge."""
    method = radau(4)
    at = Stages(velocity(node) for node in method.nodes)
    still = Stages((0.0,) * 4)
    found = make_corners(method)(
        Spatial((0.0, 0.0, 0.0), (c, 0.0, 0.0)),
        Spatial((0.0, 0.0, 0.0), (velocity(0.0), 0.0, 0.0)),
        Spatial((still, still, still), (at, still, still)),
    )
    rates = np.array([-c * abs(v) * v for v in at])
    return np.array(method.matrix) @ rates, np.array(found.linear[0])


@pytest.mark.parametrize("zero", [0.01, 0.05, 0.3, 0.41, 0.8, 0.99])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_quadrature_with_corners_is_exact_for_a_velocity_that_is_linear_in_time(zero, side):
    taken, missing = corner_of(lambda t: side * 1.7 * (t - zero))
    exact = [
        quad(
            lambda t: -3.0 * side * 1.7**2 * abs(t - zero) * (t - zero),
            0.0,
            node,
            points=(zero,),
            epsabs=1e-14,
        )[0]
        for node in radau(4).nodes
    ]
    assert taken + missing == pytest.approx(exact, abs=1e-13)


def test_quadrature_with_corners_follows_a_curved_velocity():
    """The cubic that it sees is the velocity itself; what is left is the quadrature's error on its square."""

    def velocity(t):
        return (t - 0.37) * (2.0 + 0.3 * t - 0.2 * t * t)

    taken, missing = corner_of(velocity)
    exact = [
        quad(lambda t: -3.0 * abs(velocity(t)) * velocity(t), 0.0, node, points=(0.37,), epsabs=1e-14)[0]
        for node in radau(4).nodes
    ]
    method = radau(4)
    smooth = [quad(lambda t: 3.0 * velocity(t) ** 2, 0.0, node, epsabs=1e-14)[0] for node in method.nodes]
    left = np.array(method.matrix) @ [3.0 * velocity(node) ** 2 for node in method.nodes] - smooth
    assert taken + missing - exact == pytest.approx(left, abs=1e-13)
    assert left[-1] == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("velocity", [lambda t: 1.0 + t, lambda t: (t - 0.2) * (t - 0.6), lambda t: 0.0 * t])
def test_without_a_single_zero_nothing_is_added(velocity):
    assert not corner_of(velocity)[1].any()


# Order

DAMPED = {
    "linear": {"linear": True},
    "quadratic": {"quadratic": QUADRATIC},
    "everything": {"linear": True, "quadratic": QUADRATIC, **GRAVITY},
}


@pytest.mark.parametrize("name", DAMPED)
def test_order_seven(name, monkeypatch):
    """Velocities keep their signs. Sweeps that end early cost little: they are let go on to round-off beside."""
    rng = np.random.default_rng(7)
    case = dict(DAMPED[name])
    m = random_inertia(rng, 5.0)
    if "linear" in case:
        case["linear"] = random_damping(rng)
    q, velocity = random_quaternion(rng), 0.5 + 0.5 * rng.uniform(size=6)
    wrench = np.abs(rng.normal(size=6)) * 6.0
    reference = solve(m, np.zeros(3), q, velocity, 0.5, wrench=wrench, rtol=3e-14, **case)
    counts, measured = np.array([4, 6, 8, 12]), {}
    for early in (True, False):
        if not early:
            for ending in ("ENDING", "STIFF_ENDING"):
                monkeypatch.setattr(radau_sweeps, ending, Ending(0.0, 0.0, 0.0, 0.06))
        series = []
        for count in counts:
            body = damped_body(m, 0.5 / count, **case)
            body.reset(np.zeros(3), q, velocity)
            body.step(wrench, int(count))
            assert body.fallback_steps == 0
            series.append(errors(body, reference))
        measured[early] = np.array(series).T
    for kind, series, early in zip(
        ("position", "attitude", "velocity"), measured[False], measured[True], strict=True
    ):
        assert observed_order(0.5 / counts, series) == pytest.approx(7.0, abs=0.4), f"{kind}: {series}"
        assert np.exp(np.mean(np.log(early / series))) < 5.0, f"{kind}: {early / series}"


@pytest.mark.parametrize("seed", sweep([11, 12, 13], plain=[11]))
def test_velocities_that_turn_round_cost_little(seed):
    """Five or six pass through zero. A step across |nu| nu errs by h^3, unless its corner is followed."""
    rng = np.random.default_rng(seed)
    m = random_inertia(rng, 5.0)
    q, velocity = random_quaternion(rng), 0.5 + 0.5 * rng.uniform(size=6)
    wrench = -(4.0 + 3.0 * rng.uniform(size=6))
    reference = solve(m, np.zeros(3), q, velocity, 1.0, wrench=wrench, rtol=3e-14, quadratic=QUADRATIC)
    counts = np.array([2, 3, 4, 5, 6, 8, 10, 12, 16, 24, 32])
    measured = {}
    for corners in (True, False):
        series = []
        for count in counts:
            body = damped_body(m, 1.0 / count, quadratic=QUADRATIC)
            if not corners:
                method = make_radau_method(DIAGONAL, grows=False)
                without = replace(body._composition, method=method)
                body = PlainBody(without, lambda _, numbers=body.parameters: numbers, 1.0 / count)
            body.reset(np.zeros(3), q, velocity)
            body.step(wrench, int(count))
            series.append(max(errors(body, reference)))
        assert (body.velocity_body < 0.0).sum() >= 5
        measured[corners] = np.array(series)
    assert observed_order(1.0 / counts, measured[True]) > 4.2, measured
    assert observed_order(1.0 / counts, measured[False]) < 3.7, measured
    assert np.exp(np.mean(np.log(measured[False] / measured[True]))) > 5.0


# Stiffness


@pytest.mark.parametrize("stiffness", 10.0 ** np.arange(-2, 7, 2))
def test_linear_damping_of_any_stiffness_decays_without_a_fallback(stiffness):
    h = 0.1
    body = damped_body(np.eye(6), h, linear=stiffness / h * np.eye(6))
    body.reset(velocity_body=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.step(steps=20)
    assert abs(body.velocity_body[0]) <= np.exp(-min(20.0 * stiffness, 30.0)) * 1.1 + 1e-12
    assert body.fallback_steps == 0


@pytest.mark.parametrize("factor", sweep(10.0 ** np.arange(-1, 9, 1.5), plain=(1e5, 1e8)))
@pytest.mark.parametrize("h", sweep((0.01, 0.1, 1.0), plain=(0.1,)))
def test_stiff_bodies_come_to_where_drag_balances_the_wrench(h, factor):
    """From any velocity, with a full M and the damping of all axes; 1e8 is h lambda of some 1e7."""
    rng = np.random.default_rng(2)
    m, linear = random_inertia(rng), factor * random_damping(rng)
    quadratic = factor * np.array(QUADRATIC)
    body = damped_body(m, h, linear=linear, quadratic=quadratic)
    body.reset(np.zeros(3), random_quaternion(rng), 0.5 * rng.normal(size=6))
    wrench = rng.normal(size=6)
    body.step(wrench, 60)
    assert body.steps_taken == 60
    nu = body.velocity_body
    drag = linear @ nu + quadratic * np.abs(nu) * nu
    if factor * h > 1e3:
        assert drag == pytest.approx(wrench, abs=1e-4 * np.abs(wrench).max())
    assert np.isfinite(body.get_state()).all()


@pytest.mark.parametrize("quadratic", [False, True])
def test_the_terminal_velocity_is_a_fixed_point(quadratic):
    """Surge alone, so that nothing turns: the wrench that drag balances keeps the velocity to the last bits."""
    surge = 0.7
    coefficients = np.array(QUADRATIC) if quadratic else np.zeros(6)
    linear = np.diag([2.0, 3.0, 4.0, 1.0, 1.0, 1.0]) * 1e3
    body = damped_body(np.diag([20.0, 25.0, 30.0, 1.0, 2.0, 3.0]), 0.5, linear=linear, quadratic=coefficients)
    body.reset(velocity_body=(surge, 0.0, 0.0, 0.0, 0.0, 0.0))
    force = (linear[0, 0] + coefficients[0] * surge) * surge
    body.step((force, 0.0, 0.0, 0.0, 0.0, 0.0), 50)
    assert body.velocity_body == pytest.approx((surge, 0.0, 0.0, 0.0, 0.0, 0.0), abs=1e-15)
    assert body.position_ned == pytest.approx((25.0 * surge, 0.0, 0.0), rel=1e-14)
    assert body.fallback_steps == 0


def test_steps_that_are_not_solved_are_taken_by_the_fallback_and_counted():
    """Half a turn in a step is too much for sweeps and for Newton's method."""
    body = damped_body(np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0]), 1.0, linear=1e-3 * np.eye(6))
    body.reset(velocity_body=(0.3, 0.2, 0.1, 8.0, 12.0, 10.0))
    energy = body.kinetic_energy
    body.step(steps=6)
    assert body.fallback_steps > 0
    assert body.steps_taken == 6
    assert body.kinetic_energy < 1.05 * energy


def test_drag_of_strips_and_couplings_is_damping_too():
    """Against equations that are written separately; velocities keep their signs."""
    rng = np.random.default_rng(5)
    m = random_inertia(rng, 5.0)
    couplings = np.zeros((6, 6, 6))
    couplings[5, 1, 0], couplings[1, 5, 0] = 1.5, -0.7
    case = {"linear": random_damping(rng), "quadratic": QUADRATIC, "couplings": couplings, "strips": STRIPS}
    q, velocity, wrench = random_quaternion(rng), 0.5 + 0.5 * rng.uniform(size=6), 5.0 * np.ones(6)
    reference = solve(m, np.zeros(3), q, velocity, 0.4, wrench=wrench, rtol=3e-13, **case)
    body = damped_body(m, 0.02, **case)
    body.reset(np.zeros(3), q, velocity)
    body.step(wrench, 20)
    assert max(errors(body, reference)) < 1e-8
    assert body.fallback_steps == 0


@pytest.mark.sweep  # tests/algebra/test_purity.py has the plain case
def test_plain_python_and_compiled_agree_bit_for_bit():
    """With weak damping and stiff, and across zeros of velocities."""
    rng = np.random.default_rng(0)
    for factor in (1.0, 1e3):
        case = {"linear": factor * np.eye(6), "quadratic": factor * np.array(QUADRATIC), **GRAVITY}
        m, q, velocity = random_inertia(rng), random_quaternion(rng), 0.5 * rng.normal(size=6)
        plain, compiled = damped_body(m, 0.1, **case), make_body(m, 0.1, scheme="gauss", order=8, **case)
        for body in (plain, compiled):
            body.reset(np.zeros(3), q, velocity)
            for wrench in (np.ones(6), -20.0 * np.ones(6)):
                body.step(wrench, 6)
        assert np.array_equal(plain.get_state(), compiled.get_state())
        assert plain.newton_iterations == compiled.newton_iterations
