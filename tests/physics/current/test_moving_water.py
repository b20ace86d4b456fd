"""Currents that vary with depth and time: against separately written equations, closed forms and conservation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.bodies import PlainBody, make_body, random_inertia, random_quaternion
from support.fossen import errors, solve
from support.moving_water import solve_in_moving_water
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.errors import InvalidInputError
from dq_marine.physics.current.build import CurrentProfile, GaussMarkovCurrent
from dq_marine.physics.current.formulas.unsteady import (
    UNSTEADY_WATER,
    Course,
    Displacement,
    Process,
    UnsteadyCurrent,
)
from dq_marine.physics.term import WaterTerm
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.analysis.ellipsoids import ellipsoid

DURATION = 1.0
COUNTS = np.array([100, 200, 400, 800])
DAMPING = (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)
NO_PROCESS = Process((0.0, 0.0, 0.0), 1.0, 0.0, 1.0)
LAYERS = CurrentProfile([-2.0, 0.3, 0.8, 4.0], [[0.9, -0.4], [0.2, 0.5], [1.1, 0.1], [-0.6, 0.3]])
SLOPE = CurrentProfile([-50.0, 50.0], [[-20.0, 10.0], [20.0, -10.0]])


def profile_water(profile):
    return profile.term(load_vehicle("bluerov2_heavy"))


def ramp(velocity, rate, excess, moment):
    course = Course(velocity, rate, 0.0)
    return WaterTerm(
        "ramp", UNSTEADY_WATER, UnsteadyCurrent(course, Displacement(excess, moment), NO_PROCESS)
    )


def start(rng):
    velocity = rng.normal(size=6)
    return rng.normal(size=3), random_quaternion(rng), np.sign(velocity) * (0.5 + np.abs(velocity))


def slopes(m, case, begin, reference, wrench, order=2, counts=COUNTS, scheme="midpoint"):
    measured = []
    for count in counts:
        body = make_body(m, DURATION / count, order=order, scheme=scheme, kind=PlainBody, **case)
        body.reset(*begin)
        body.step(wrench, int(count))
        assert body.fallback_steps == 0
        measured.append(errors(body, reference))
    return [observed_order(DURATION / counts, series) for series in np.array(measured).T]


@pytest.mark.parametrize("profile", [SLOPE, LAYERS], ids=["one slope", "corners"])
def test_order_two_in_a_profile(profile):
    rng = np.random.default_rng(5)
    m, begin, wrench = random_inertia(rng), start(rng), np.array([4.0, -2.0, 3.0, 1.0, -1.0, 2.0])
    begin = (np.array([0.0, 0.0, 0.55]), *begin[1:])
    still = np.zeros(3)
    reference = solve_in_moving_water(
        m, *begin, DURATION, lambda t, x: profile.at(x[2]), lambda t, x: still,
        quadratic=DAMPING, wrench=wrench, corners=profile.depths,
    )  # fmt: skip
    crossed = np.abs(reference[0][2] - 0.55)
    assert crossed > 0.3, "the body must meet a corner"
    case = {"current": profile_water(profile), "quadratic": DAMPING}
    # A corner is met anywhere within a step, so errors scatter about their slope.
    for order in slopes(m, case, begin, reference, wrench):
        assert abs(order - 2.0) < (0.05 if profile is SLOPE else 0.25), order


WITH_STAGES = {
    ("galerkin", 4): [16, 24, 32],
    ("galerkin", 6): [11, 14, 18],
    ("galerkin", 8): [12, 16, 20, 24],
    ("gauss", 8): [12, 16, 20, 24],
    ("runge_kutta", 8): [6, 10, 16, 28],
}
"""Steps of the motion, by scheme and order.

Few and many of the last: errors of its eighth order are small, and cancel with those of the next on the way.
"""
IN_A_SLOPE = {
    **WITH_STAGES,
    ("galerkin", 8): [16, 20, 24, 28],
    ("gauss", 8): [16, 20, 24, 28],
    ("runge_kutta", 8): [16, 20, 24, 28],
    ("midpoint", 4): [20, 40, 80],
    ("midpoint", 6): [20, 40, 80],
}


@pytest.mark.parametrize(("scheme", "order"), sweep(IN_A_SLOPE, plain=[("gauss", 8), ("midpoint", 4)]))
def test_higher_orders_hold_in_a_slope(scheme, order):
    rng = np.random.default_rng(6)
    m, begin = random_inertia(rng), start(rng)
    still = np.zeros(3)
    reference = solve_in_moving_water(m, *begin, DURATION, lambda t, x: SLOPE.at(x[2]), lambda t, x: still)
    case, counts = {"current": profile_water(SLOPE)}, np.array(IN_A_SLOPE[scheme, order])
    for found in slopes(m, case, begin, reference, np.zeros(6), order, counts, scheme):
        assert found > order - 0.4, found


@pytest.mark.sweep
def test_schemes_with_stages_cross_a_corner_better_than_order_two_and_with_its_slope():
    """A step that holds a corner errs by its square, as every step of order two does; no other step does.

    Where in a step the corner lies makes a difference: errors are the largest of many starts.
    """
    corner = CurrentProfile([0.0, 5.0, 10.0], [[0.5, 0.0], [0.5, 0.0], [-0.5, 0.4]])
    rng = np.random.default_rng(0)
    m, q, spin = 20.0 * random_inertia(rng, 10.0), random_quaternion(rng), 0.3 * rng.normal(size=3)
    velocity = np.concatenate([Rotation.from_quat(np.roll(q, -1)).inv().apply((0.3, -0.1, 0.5)), spin])
    counts, still = np.array([6, 12, 24]), np.zeros(3)
    case = {"current": profile_water(corner), "kind": PlainBody}
    methods = (("midpoint", 2), ("galerkin", 4), ("gauss", 8), ("runge_kutta", 8))
    worst = {scheme: np.zeros(len(counts)) for scheme, _ in methods}
    for depth in np.linspace(4.64, 4.75, 16):
        begin = (np.array([0.0, 0.0, depth]), q, velocity)
        reference = solve_in_moving_water(
            m, *begin, DURATION, lambda t, x: corner.at(x[2]), lambda t, x: still, corners=corner.depths
        )
        assert reference[0][2] > 5.05, "the body must cross the corner"
        for scheme, order in methods:
            for k, count in enumerate(counts):
                body = make_body(m, DURATION / count, scheme=scheme, order=order, **case)
                body.reset(*begin)
                body.step(steps=int(count))
                worst[scheme][k] = max(worst[scheme][k], *errors(body, reference))
    for scheme in ("galerkin", "gauss", "runge_kutta"):
        assert (worst[scheme] < 0.02 * worst["midpoint"]).all(), worst
        assert observed_order(DURATION / counts, worst[scheme]) > 1.7, worst


def test_order_two_in_a_current_that_changes_with_time():
    rng = np.random.default_rng(7)
    m, begin, wrench = random_inertia(rng), start(rng), np.array([4.0, -2.0, 3.0, 1.0, -1.0, 2.0])
    u, a, excess, moment = (0.4, -0.3, 0.1), (1.5, 0.7, -0.4), -2.0, (0.3, -0.2, 0.9)
    reference = solve_in_moving_water(
        m, *begin, DURATION, lambda t, x: np.array(u) + t * np.array(a), lambda t, x: np.array(a),
        excess=excess, moment=moment, quadratic=DAMPING, wrench=wrench,
    )  # fmt: skip
    case = {"current": ramp(u, a, excess, moment), "quadratic": DAMPING}
    for order in slopes(m, case, begin, reference, wrench):
        assert abs(order - 2.0) < 0.05, order


@pytest.mark.parametrize(("scheme", "order"), sweep(WITH_STAGES, plain=[("galerkin", 4)]))
def test_higher_orders_hold_in_a_current_that_changes_with_time(scheme, order):
    rng = np.random.default_rng(7)
    m, begin, wrench = random_inertia(rng), start(rng), np.array([4.0, -2.0, 3.0, 1.0, -1.0, 2.0])
    u, a, excess, moment = (0.4, -0.3, 0.1), (1.5, 0.7, -0.4), -2.0, (0.3, -0.2, 0.9)
    reference = solve_in_moving_water(
        m, *begin, DURATION, lambda t, x: np.array(u) + t * np.array(a), lambda t, x: np.array(a),
        excess=excess, moment=moment, wrench=wrench,
    )  # fmt: skip
    case, counts = {"current": ramp(u, a, excess, moment)}, np.array(WITH_STAGES[scheme, order])
    for found in slopes(m, case, begin, reference, wrench, order, counts, scheme):
        assert found > order - 0.4, found


def test_a_profile_of_one_velocity_is_a_uniform_current():
    velocity = (0.6, -0.3)
    constant = CurrentProfile([0.0, 3.0, 6.0, 10.0], [velocity] * 4)
    bodies = [Scene(current=current).stepper() for current in (constant, (*velocity, 0.0))]
    for body in bodies:
        body.reset((1.0, 2.0, 4.0), (0.8, 0.0, 0.6, 0.0), (1.0, 0.2, -0.5, 0.1, 0.3, -0.2))
        body.step((30.0, -10.0, 20.0, 1.0, 2.0, -1.0), 200)
    sheared, uniform = (np.concatenate([body.get_state(), body.velocity_body]) for body in bodies)
    assert np.abs(sheared - uniform).max() < 1e-12 * (1.0 + np.abs(uniform).max())


def test_the_drifting_frame_is_the_earth_fixed_form():
    rng = np.random.default_rng(8)
    m, begin, current = random_inertia(rng, condition=5.0), start(rng), (0.5, -0.3, 0.2)
    reference = solve(m, *begin, DURATION, current=current)
    body = make_body(m, DURATION / 400, order=8, current=current, kind=PlainBody)
    body.reset(*begin)
    body.step(steps=400)
    assert max(errors(body, reference)) < 1e-10


@pytest.mark.parametrize(("scheme", "order"), [("galerkin", 4), ("gauss", 8), ("runge_kutta", 8)])
def test_with_stages_a_profile_of_one_velocity_is_a_uniform_current(scheme, order):
    velocity = (0.6, -0.3)
    constant = profile_water(CurrentProfile([0.0, 3.0, 6.0, 10.0], [velocity] * 4))
    m, q = random_inertia(np.random.default_rng(9)), random_quaternion(np.random.default_rng(9))
    states = []
    for current in (constant, (*velocity, 0.0)):
        case = {"excess_weight": 2.0, "linear": np.eye(6), "current": current}
        body = make_body(m, 0.1, scheme=scheme, order=order, kind=PlainBody, **case)
        body.reset((1.0, 2.0, 4.0), q, (1.0, 0.2, -0.5, 0.1, 0.3, -0.2))
        body.step((3.0, -1.0, 2.0, 0.1, 0.2, -0.1), 20)
        assert body.fallback_steps == 0
        states.append(body.get_state())
    assert np.abs(states[0] - states[1]).max() < 1e-12 * (1.0 + np.abs(states[1]).max())


@pytest.mark.parametrize(("scheme", "order"), [("galerkin", 4), ("gauss", 8), ("runge_kutta", 8)])
def test_with_stages_a_free_sphere_keeps_its_velocity_over_ground_in_shear(scheme, order):
    """Whatever corners it meets: only the water around it changes, not what it does."""
    sphere, q = np.diag([3.0] * 3 + [1.0] * 3), random_quaternion(np.random.default_rng(2))
    body = make_body(sphere, 0.1, scheme=scheme, order=order, current=profile_water(LAYERS), kind=PlainBody)
    velocity = np.array([0.3, -0.8, 0.5])
    along = Rotation.from_quat(np.roll(q, -1)).inv().apply(velocity)
    body.reset((0.0, 0.0, -3.0), q, (*along, 0.0, 0.0, 0.9))
    body.step(steps=120)
    attitude = Rotation.from_quat(np.roll(body.quaternion_body_to_ned, -1))
    assert body.position_ned[2] == pytest.approx(3.0, abs=1e-9)
    assert body.fallback_steps == 0
    assert np.abs(attitude.apply(body.velocity_body[:3]) - velocity).max() < 1e-12


def test_stiff_damping_in_a_profile_is_solved_and_agrees_with_small_steps():
    """With h lambda of some 100: in the profile, the stages are where the body is, and so is its water."""
    stiff = {"linear": 1e3 * np.eye(6), "current": profile_water(SLOPE)}
    rng = np.random.default_rng(4)
    m, begin, wrench = random_inertia(rng), start(rng), 1e3 * rng.normal(size=6)
    radau = make_body(m, 0.1, scheme="gauss", order=8, kind=PlainBody, **stiff)
    fine = make_body(m, 0.001, kind=PlainBody, **stiff)
    for body, count in ((radau, 5), (fine, 500)):
        body.reset(*begin)
        body.step(wrench, count)
    assert radau.fallback_steps == 0
    rotation = Rotation.from_quat(np.roll(fine.quaternion_body_to_ned, -1)).as_matrix()
    end = (fine.position_ned, rotation, fine.velocity_body)
    assert max(errors(radau, end)) < 1e-3


def test_a_free_body_keeps_its_velocity_over_ground_in_shear():
    body = Scene(ellipsoid(0.5, 0.5, 0.5), current=LAYERS, step=0.05).stepper()
    velocity = np.array([0.3, -0.8, 0.4, 0.0, 0.0, 0.0])
    body.reset((0.0, 0.0, -3.0), velocity_body=velocity)
    body.step(steps=400)
    assert body.position_ned[2] == pytest.approx(5.0, abs=1e-9)
    assert np.abs(body.velocity_body - velocity).max() < 1e-12


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_a_sphere_in_accelerating_water(ratio):
    """(m + m_A) v' = (rho V + m_A) a, m_A = rho V/2; a neutral one goes with the water, exactly."""
    displaced = 2.0
    m = np.diag([(ratio + 0.5) * displaced] * 3 + [1.0] * 3)
    rate = np.array([0.3, -0.2, 0.1])
    body = make_body(m, 0.1, current=ramp((0.0,) * 3, tuple(rate), (1.0 - ratio) * displaced, (0.0,) * 3))
    body.reset()
    body.step(steps=50)
    gained = 1.5 / (ratio + 0.5) * rate
    assert np.abs(body.velocity_body[:3] - 5.0 * gained).max() < 1e-13
    assert np.abs(body.position_ned - 12.5 * gained).max() < 1e-12


def test_a_neutral_body_drifts_with_a_changing_current():
    current = GaussMarkovCurrent((0.2, 0.1, 0.0), 0.3, 5.0)
    body = Scene(ellipsoid(0.5, 0.2, 0.2), current=current).stepper()
    body.reset(velocity_body=(0.2, 0.1, 0.0, 0.0, 0.0, 0.0))
    course = current.sample(0.1, 100, seed=1)
    way, before = np.zeros(3), np.array(current.mean)
    for velocity in course:
        body.change_current(velocity, 0.1)
        body.step(steps=5)
        way, before = way + 0.05 * (before + velocity), velocity
        assert np.abs(body.velocity_body[:3] - velocity).max() < 1e-13
    assert np.abs(body.position_ned - way).max() < 1e-12


def test_time_runs_backwards_in_a_profile():
    """The motion is chaotic: of one start in seven round-off grows beyond 1e-11 in 400 steps, of most it does not."""
    forwards, backwards = (
        make_body(np.diag([3.0, 5.0, 6.0, 1.0, 2.0, 2.5]), h, current=profile_water(LAYERS))
        for h in (0.05, -0.05)
    )
    rng, missed = np.random.default_rng(3), []
    for _ in range(40):
        forwards.reset(*start(rng))
        begin = forwards.get_state()
        forwards.step(steps=200)
        backwards.set_state(forwards.get_state())
        backwards.step(steps=200)
        missed.append(np.abs(backwards.get_state() - begin).max())
    assert np.median(missed) < 5e-12
    assert max(missed) < 1e-8


METHODS = [("midpoint", 2), ("gauss", 8), ("galerkin", 4), ("runge_kutta", 8)]


@pytest.mark.sweep
@pytest.mark.parametrize(("scheme", "order"), METHODS)
def test_bodies_in_a_profile_are_the_same_alone_and_in_lanes(scheme, order):
    profile = CurrentProfile.power_law((0.8, 0.2), 30.0, layers=3)
    scene = Scene(current=profile, scheme=scheme, order=order)
    rng = np.random.default_rng(0)
    rows = [(rng.normal(size=3) * 20.0, random_quaternion(rng), rng.normal(size=6)) for _ in range(11)]
    batch, body = scene.batch(11, threads=1), scene.stepper()
    batch.reset(*(np.array(column) for column in zip(*rows, strict=True)))
    wrench = rng.normal(size=6) * 10.0
    batch.step(wrench, 20)
    for k, row in enumerate(rows):
        body.reset(*row)
        body.step(wrench, 20)
        assert np.array_equal(batch.get_state()[k], body.get_state())


def test_samples_are_the_process():
    current = GaussMarkovCurrent((0.5, -0.2, 0.1), 0.2, 4.0)
    deviations = current.sample(0.5, 40_000, seed=0) - np.array(current.mean)
    assert not deviations[:, 2].any()
    # Some 40000 0.5/(2 4) = 2500 independent samples: 2 % of the deviation.
    assert np.abs(deviations[:, :2].mean(axis=0)).max() < 0.02
    assert np.abs(deviations[:, :2].std(axis=0) - 0.2).max() < 0.01
    for lag in (1, 4, 8):
        correlation = (deviations[lag:, 0] * deviations[:-lag, 0]).mean() / 0.04
        assert correlation == pytest.approx(np.exp(-0.5 * lag / 4.0), abs=0.07)


def test_scenes_with_such_currents_travel():
    for current in (LAYERS, GaussMarkovCurrent(), {"depths": [0, 1], "velocities": [[0, 0], [1, 0]]}):
        scene = Scene(current=current)
        again = scene.__reduce__()[0](*scene.__reduce__()[1])
        assert again.current == scene.current
        assert again.composition == scene.composition


@pytest.mark.parametrize(
    ("current", "complaint"),
    [
        ({"depths": [0.0], "velocities": [[1.0, 0.0]]}, "give 2 to 33"),
        ({"depths": [0.0, 0.0], "velocities": [[1.0, 0.0]] * 2}, "do not increase"),
        ({"depths": [0.0, 1.0], "velocities": [[1.0, 0.0]]}, "1 rows for 2 depths"),
        ({"depths": [0.0, 1.0], "velocities": [[1.0, 0.0], [1.0]]}, r"velocities\[1\] has shape"),
        ({"depths": [0.0, np.nan], "velocities": [[1.0, 0.0]] * 2}, "not finite"),
        ({"depths": [0.0, 1.0], "velocities": [[1.0, 0.0], [50.0, 0.0]]}, "at most 20 m/s"),
        ({"depths": [0.0, 1.0], "velocities": 3.0}, "a row for each depth"),
        ({"depths": [0.0, 1.0]}, "lacks some"),
        ({"depth": [0.0, 1.0]}, "current has keys"),
        ({}, "current has keys"),
        ({"standard_deviation": -1.0}, "give 0 or more"),
        ({"correlation_time": 0.0}, "above 0"),
        ({"mean": [1.0, 2.0]}, "has shape"),
    ],
)
def test_what_is_no_current_is_refused(current, complaint):
    with pytest.raises(InvalidInputError, match=complaint):
        Scene(current=current)


def test_a_stepper_refuses_to_change_a_steady_current():
    body = Scene().stepper()
    with pytest.raises(InvalidInputError, match="does not change"):
        body.change_current((0.1, 0.0, 0.0), 1.0)
    with pytest.raises(InvalidInputError, match="control periods"):
        Scene(current=GaussMarkovCurrent()).batch(3)
