"""The stepper's doors: states, refusals, bad input; current and constant water."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.bodies import make_body, random_damping, random_inertia, random_quaternion

from dq_marine.algebra.dual_quaternion import dual_multiply, pose_from_parts
from dq_marine.algebra.spatial import Spatial
from dq_marine.errors import InvalidInputError, StepNotSolvableError
from dq_marine.integrator.drift import MAX_PIECES, make_drift, make_newton
from dq_marine.integrator.drift_report import drift_accepted, equation_met
from dq_marine.integrator.midpoint_drift import MIDPOINT
from dq_marine.integrator.paper_drift import PAPER
from dq_marine.physics.matrices import inertia_term
from dq_marine.simulation.scene import Scene

seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=20)
@given(seeds)
def test_reset_round_trip(seed):
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng), 0.02, current=(0.5, -0.2, 0.1))
    position, q, velocity = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    body.reset(position, q, velocity)
    assert np.allclose(body.position_ned, position, atol=1e-14)
    assert np.allclose(body.quaternion_body_to_ned, q, atol=1e-15)
    assert np.allclose(body.velocity_body, velocity, atol=1e-12)
    assert body.time == 0.0


@settings(max_examples=20)
@given(seeds)
def test_a_current_is_exactly_a_moving_frame(seed):
    """In a current the body does what it does in still water, seen from a frame that moves with the water."""
    rng = np.random.default_rng(seed)
    m, damping, current = random_inertia(rng), random_damping(rng), rng.normal(size=3)
    q, relative = random_quaternion(rng), rng.normal(size=6)
    still = make_body(m, 0.02, linear=damping, arm=(0.0, 0.0, 2.0))
    moving = make_body(m, 0.02, linear=damping, arm=(0.0, 0.0, 2.0), current=current)
    still.reset((0.0, 0.0, 0.0), q, relative)
    moving.reset((0.0, 0.0, 0.0), q, moving.velocity_body * 0.0)
    water = moving.velocity_body - moving.relative_velocity_body
    moving.reset((0.0, 0.0, 0.0), q, relative + water)
    wrench = rng.normal(size=6)
    still.step(wrench, 500)
    moving.step(wrench, 500)
    assert np.allclose(moving.position_ned, still.position_ned + 10.0 * current, atol=1e-11)
    assert np.allclose(moving.relative_velocity_body, still.velocity_body, atol=1e-12)


def test_a_floating_body_drifts_with_the_water():
    body = make_body(random_inertia(np.random.default_rng(0)), 0.1, current=(0.3, 0.4, 0.0))
    body.reset(velocity_body=(0.3, 0.4, 0.0, 0.0, 0.0, 0.0))
    body.step(steps=1000)
    assert np.allclose(body.position_ned, (30.0, 40.0, 0.0), atol=1e-10)


def test_state_round_trip_is_bit_for_bit():
    scene = Scene(current=(0.2, 0.1, 0.0))
    body, other = scene.stepper(), scene.stepper()
    body.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8), (0.1,) * 6)
    body.step((10.0, 0.0, 0.0, 0.0, 0.0, 1.0), 13)
    other.set_state(body.get_state())
    for stepper in (body, other):
        stepper.step((5.0, 1.0, 0.0, 0.0, 0.0, -1.0), 29)
    assert np.array_equal(body.get_state(), other.get_state())
    assert body.time == pytest.approx(42 * 0.02)


def test_scenes_travel_and_steppers_say_why_they_do_not():
    scene = Scene(current=(0.2, 0.1, 0.0), step=0.01)
    for twin in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
        assert repr(twin) == repr(scene)
        one, two = scene.stepper(), twin.stepper()
        one.step((10.0,) * 6, 5)
        two.step((10.0,) * 6, 5)
        assert np.array_equal(one.get_state(), two.get_state())
    with pytest.raises(TypeError, match="get_state"):
        pickle.dumps(scene.stepper())


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda b: b.step((np.nan,) * 6), "wrench_body"),
        (lambda b: b.step((np.inf, 0, 0, 0, 0, 0)), "wrench_body"),
        (lambda b: b.step((1.0, 2.0)), r"shape \(2,\)"),
        (lambda b: b.step("forward"), "not numeric"),
        (lambda b: b.step(steps=0), "steps = 0"),
        (lambda b: b.step(steps=1.5), "steps = 1.5"),
        (lambda b: b.reset(quaternion_body_to_ned=(2.0, 0.0, 0.0, 0.0)), "length 2"),
        (lambda b: b.reset(position_ned=(np.nan, 0.0, 0.0)), "position_ned"),
        (lambda b: b.reset(velocity_body=(1e308,) * 6), "momentum is infinite"),
        (lambda b: b.set_state(np.zeros(15)), "unit quaternion"),
        (lambda b: b.set_state(np.zeros(3)), "shape"),
    ],
)
def test_bad_input_is_refused_and_changes_nothing(call, message):
    body = Scene().stepper()
    body.step((10.0, 0.0, 0.0, 0.0, 0.0, 1.0), 5)
    before = body.get_state()
    with pytest.raises(InvalidInputError, match=message):
        call(body)
    assert np.array_equal(body.get_state(), before)


SPHEROID = np.diag([35.39387824, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877])
MUNK_RATE = 2.301752703506763  # growth rate at 1 m/s


def test_a_step_beyond_the_translation_limit_is_split():
    """Up to h sigma = 2 plain Newton solves the step; beyond, on the wrong branch, it is split, and counted."""
    for speed, fallbacks in ((1.9 / MUNK_RATE, 0), (2.1 / MUNK_RATE, 1)):
        body = make_body(SPHEROID, 1.0)
        body.reset(velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
        body.step()
        assert body.fallback_steps == fallbacks
        assert np.allclose(body.position_ned, (speed, 0.0, 0.0), atol=1e-12)


def test_a_step_beyond_the_fallback_is_refused_by_name():
    """At h sigma = 2 in the smallest pieces they leave the branch too."""
    body = make_body(SPHEROID, 1.0)
    body.reset(velocity_body=(2.0 * MAX_PIECES / MUNK_RATE * 1.01, 0.0, 0.0, 0.0, 0.0, 0.0))
    before = body.get_state()
    with pytest.raises(StepNotSolvableError, match="wrong_branch") as caught:
        body.step()
    assert np.array_equal(body.get_state(), before)
    assert caught.value.step_times_speed == pytest.approx(2.0 * MAX_PIECES / MUNK_RATE * 1.01)
    assert caught.value.admissible_step == 0.5
    again = make_body(SPHEROID, caught.value.admissible_step)
    again.set_state(before)
    again.step(steps=2)


@settings(max_examples=40)
@given(seeds, st.floats(0.0, 1.7), st.sampled_from([MIDPOINT, PAPER]))
@example(524289, 1.2143266763586609, PAPER)  # Newton's method leaves for 1e148, where a determinant is zero
def test_what_newton_accepts_is_on_the_branch_from_rest(seed, log_size, scheme):
    """It is where small steps along that branch arrive."""
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng), 0.1)
    velocity = rng.normal(size=6)
    body.reset(velocity_body=velocity * 10.0**log_size / np.linalg.norm(velocity))
    inertia, (pose, momentum, _) = body.parameters.inertia, body.state
    with np.errstate(all="ignore"):  # NumPy's doubles are infinite where compiled code's are; Python's raise
        doubles = Spatial(*(tuple(np.array(part)) for part in momentum))
        moved, _, report = make_drift(scheme)(inertia, 0.1, pose, doubles)
    if equation_met(report.solver):
        followed = follow_from_rest(scheme, inertia, 0.1, momentum)
        assert np.allclose(moved.real, pose_after(scheme, followed, pose).real, atol=1e-8)


def follow_from_rest(scheme, inertia, h, momentum):
    """The discrete equation's solution at full momentum, by 500 small steps along the branch from rest."""
    x, newton = (0.0, 0.0, 0.0), make_newton(scheme)
    a, b = (0.5 * h * np.array(part) for part in momentum)
    for s in np.linspace(0.0, 1.0, 501)[1:]:
        equation, _ = newton(inertia, x, tuple(s * a), tuple(s * b))
        x = equation[0]
    return equation


def pose_after(scheme, equation, pose):
    return dual_multiply(pose, scheme.increment(equation))


@settings(max_examples=60)
@given(seeds, st.floats(-3.0, 300.0))
def test_never_a_nan(seed, log_size):
    """Whatever the wrench and velocity: a finite state, or a refusal that changes nothing."""
    rng = np.random.default_rng(seed)
    body = make_body(random_inertia(rng), 0.1, quadratic=rng.uniform(size=6), linear=random_damping(rng))
    body.reset(velocity_body=rng.normal(size=6) * 10.0 ** min(log_size, 6.0))
    before = body.get_state()
    try:
        body.step(rng.normal(size=6) * 10.0**log_size, 3)
    except StepNotSolvableError as error:
        assert np.array_equal(body.get_state(), before)
        assert error.reason in str(error)
    assert np.isfinite(body.get_state()).all()
    assert np.isfinite(body.position_ned).all()
    assert np.isfinite(body.velocity_body).all()


def test_a_new_body_is_where_reset_puts_it():
    """At rest over ground, in a current too."""
    body = Scene("bluerov2_heavy", current=(0.3, -0.2, 0.1)).stepper()
    fresh = body.get_state()
    body.reset()
    assert np.array_equal(fresh, body.get_state())
    assert np.abs(body.velocity_body).max() < 1e-15


@pytest.mark.parametrize("scheme", [MIDPOINT, PAPER], ids=["midpoint", "paper"])
@given(seed=st.integers(0, 2**32 - 1), log_push=st.floats(-12.0, 2.0), log_noise=st.floats(-18.0, -8.0))
@settings(max_examples=60)
def test_a_push_without_a_moment_is_solved(scheme, seed, log_push, log_noise):
    """The momentum that translation brings in by coupling is then undone by rotation but for round-off."""
    rng = np.random.default_rng(seed)
    inertia = inertia_term(random_inertia(rng, condition=1e3))
    push = 10.0**log_push * rng.normal(size=3)
    noise = 10.0**log_noise * np.linalg.norm(push) * rng.normal(size=3)
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    momentum = Spatial(tuple(noise.tolist()), tuple(push.tolist()))
    _, _, report = make_drift(scheme)(inertia, 1e-4, pose, momentum)
    assert drift_accepted(report)


@pytest.mark.sweep  # the catalogue flies it in lanes
def test_a_heavy_coupled_vehicle_starts_from_rest():
    body = Scene("npsauv", step=0.02).stepper()
    body.step([10.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert body.velocity_body[0] > 0.0
