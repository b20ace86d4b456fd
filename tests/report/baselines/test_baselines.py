"""What baselines keep, how often they ask for forces, how they blow up; compiled and plain Python agree."""

import math

import numpy as np
import pytest
from flown import BASELINES, advance, flown, make_physics
from support.bodies import random_inertia, random_quaternion

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.screw import pose_exp
from dq_marine.algebra.spatial import Spatial
from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.step import NOT_FINITE
from dq_marine.physics.term import ForceTerm
from dq_marine.report.baselines.displacement import displaced
from dq_marine.report.methods import METHODS, SWEPT, UNSWEPT

NO_WRENCH = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
DIAGONAL = np.diag([3.0, 5.0, 9.0, 1.0, 2.0, 2.5])


class Counter:
    """Forces that count how often they are asked."""

    def __init__(self):
        self.posed = self.moving = 0

    def terms(self, with_velocity):
        def posed(parameters, pose, time):
            self.posed += 1
            return NO_WRENCH

        def moving(parameters, pose, twist, time):
            self.moving += 1
            return NO_WRENCH

        both = ForceTerm("posed", posed, ()), ForceTerm("moving", moving, (), uses_velocity=True)
        return both if with_velocity else both[:1]


def evaluations_a_step(name, with_velocity):
    """(of a pose force, of a velocity force) a step, within a longer call."""
    counts = []
    for steps in (3, 4):
        counter = Counter()
        body = METHODS[name].body(make_physics(DIAGONAL, forces=counter.terms(with_velocity)), 0.01)
        body.reset(velocity_body=np.full(6, 0.3))
        advance(body, np.zeros(6), steps)
        counts.append((counter.posed, counter.moving))
    return tuple(np.subtract(*reversed(counts)).tolist())


@pytest.mark.parametrize("name", SWEPT)
def test_sweeps_evaluate_the_forces_at_each_stage(name):
    """How many sweeps a step takes depends on the motion; this one is slow.

    A step of Gauss's method within a call begins with the rates of the step before, others with those at their start.
    """
    begun_and_swept = evaluations_a_step(name, with_velocity=False)[0]
    assert 1 < begun_and_swept <= METHODS[name].evaluations
    stages = METHODS[name].order // 2
    assert begun_and_swept % stages == (1 if name == "galerkin8" else 0)


@pytest.mark.parametrize("name", UNSWEPT)
def test_evaluations_are_what_a_method_says(name):
    method = METHODS[name]
    assert evaluations_a_step(name, with_velocity=False)[0] == method.evaluations


@pytest.mark.parametrize("name", BASELINES)
def test_a_baseline_asks_no_force_more_often_than_it_says(name):
    posed, moving = evaluations_a_step(name, with_velocity=True)
    assert (posed, moving) == (METHODS[name].evaluations, METHODS[name].damped_evaluations)


def with_everything(rng):
    """Restoring, quadratic damping and a current: what baselines are compiled for here."""
    restoring = {"excess_weight": 1.0, "arm": (0.1, 0.2, 2.0)}
    return make_physics(
        random_inertia(rng), **restoring, quadratic=rng.uniform(size=6), current=(0.3, 0.1, 0.0)
    )


@pytest.mark.parametrize("name", BASELINES)
def test_plain_python_and_compiled_agree_bit_for_bit(name):
    rng = np.random.default_rng(0)
    physics = with_everything(rng)
    start = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    wrench = rng.normal(size=6)
    plain = flown(name, physics, start, 0.25, 5, wrench)
    compiled = METHODS[name].body(physics, 0.05)
    compiled.reset(*start)
    compiled.step(wrench, 5)
    assert np.array_equal(plain.get_state()[1:], compiled.get_state()[1:])


@pytest.mark.parametrize("name", BASELINES)
def test_one_call_of_many_steps_is_many_calls_of_one(name):
    rng = np.random.default_rng(1)
    pull = ForceTerm("pull", pull_to_origin, (2.0, 0.7))
    physics = make_physics(
        random_inertia(rng), excess_weight=1.0, arm=(0.1, 0.2, 2.0), current=(0.3, 0.1, 0.0), forces=(pull,)
    )
    start = rng.normal(size=3), random_quaternion(rng), rng.normal(size=6)
    wrench = rng.normal(size=6)
    whole = flown(name, physics, start, 0.4, 20, wrench)
    pieces = METHODS[name].body(physics, 0.02)
    pieces.reset(*start)
    for _ in range(20):
        advance(pieces, wrench, 1)
    assert np.allclose(whole.get_state(), pieces.get_state(), rtol=0, atol=1e-13)


def pull_to_origin(parameters, pose, time):
    """A force that depends on where, in NED, and when."""
    stiffness, frequency = parameters
    x, y, z = pose_position(pose)
    strength = -stiffness * math.cos(frequency * time)
    return Spatial((0.0, 0.0, 0.0), (strength * x, strength * y, strength * z))


@pytest.mark.parametrize("name", BASELINES)
def test_a_body_at_rest_in_the_water_drifts_with_it(name):
    physics = make_physics(DIAGONAL, current=(0.5, -0.3, 0.2))
    body = flown(name, physics, ((0.0,) * 3, (1.0, 0.0, 0.0, 0.0), (0.5, -0.3, 0.2, 0.0, 0.0, 0.0)), 2.0, 40)
    assert np.allclose(body.position_ned, (1.0, -0.6, 0.4), rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", BASELINES)
def test_what_blows_up_is_refused_as_not_finite_and_changes_nothing(name):
    body = METHODS[name].body(with_everything(np.random.default_rng(0)), 10.0)
    body.reset(velocity_body=np.full(6, 100.0))
    before = body.get_state()
    status, *_ = body._advance(body._numbers, body._state, np.zeros(6), 0.0, 60)
    assert status == NOT_FINITE
    assert np.array_equal(body.get_state(), before)


def test_a_baseline_that_blows_up_says_which_step_would_do():
    body = METHODS["rk4_euler"].body(make_physics(DIAGONAL, quadratic=np.full(6, 30.0)), 1.0)
    body.reset(velocity_body=np.full(6, 2.0))
    with pytest.raises(StepNotSolvableError, match="not_finite") as caught:
        body.step(steps=100)
    assert 0.0 < caught.value.admissible_step < 0.5


def test_euler_angles_fail_at_a_pitch_of_90_degrees_and_quaternions_do_not():
    """A sphere that spins almost about y, past the pole: q = (cos(wt/2), sin(wt/2) axis)."""
    spin = np.array([0.02, 1.0, 0.03])
    half_angle = np.linalg.norm(spin)  # after 2 s
    exact = np.array([np.cos(half_angle), *(np.sin(half_angle) * spin / half_angle)])
    start = ((0.0,) * 3, (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, *spin))
    missed = {}
    for name in ("rk4_euler", "rk4_quaternion"):
        q = flown(name, make_physics(np.eye(6)), start, 2.0, 20).quaternion_body_to_ned
        missed[name] = min(np.linalg.norm(q - exact), np.linalg.norm(q + exact))
    assert missed["rk4_quaternion"] < 1e-6
    assert missed["rk4_euler"] > 1e3 * missed["rk4_quaternion"]


# The decoupled integrator


@pytest.mark.parametrize("m", [DIAGONAL, random_inertia(np.random.default_rng(5))], ids=["diagonal", "full"])
def test_the_decoupled_integrator_keeps_spatial_momentum(m):
    start = (np.array([1.0, 2.0, 3.0]), (0.6, 0.0, 0.8, 0.0), (0.5, -0.4, 0.3, 0.6, 0.5, -0.4))
    body = METHODS["decoupled_lie"].body(make_physics(m), 0.1)
    body.reset(*start)
    momentum = body.spatial_momentum
    advance(body, np.zeros(6), 500)
    assert np.abs(body.spatial_momentum - momentum).max() < 1e-12 * np.linalg.norm(momentum)


def test_the_decoupled_integrator_keeps_energy_and_runs_backwards_for_a_diagonal_m():
    physics = make_physics(DIAGONAL)
    body, back = (METHODS["decoupled_lie"].body(physics, h) for h in (0.1, -0.1))
    body.reset(velocity_body=(0.5, -0.4, 0.3, 0.6, 0.5, -0.4))
    start, energy, spread = body.get_state(), body.kinetic_energy, []
    for _ in range(20):
        advance(body, np.zeros(6), 100)
        spread.append(body.kinetic_energy / energy - 1.0)
    assert np.abs(spread).max() < 5e-3
    back.set_state(body.get_state())
    advance(back, np.zeros(6), 2000)
    assert np.allclose(back.get_state()[1:], start[1:], rtol=0, atol=1e-8)


# Short displacements


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-3, 0.1, 0.5, 0.59999, 0.60001, 1.0, 3.0, 6.0])
def test_a_displacement_is_the_exponential(angle):
    rng = np.random.default_rng(2)
    axis = rng.normal(size=3)
    omega = tuple((angle * axis / np.linalg.norm(axis)).tolist())
    v = tuple(rng.normal(size=3).tolist())
    way = displaced(Spatial(omega, v))
    whole = pose_exp(Spatial(omega, v))
    assert np.allclose(way.turn, whole.real, rtol=0, atol=4e-16)
    assert np.allclose(way.translation, pose_position(whole), rtol=0, atol=2e-15)


def test_a_displacement_that_is_not_finite_is_nan():
    assert np.isnan(displaced(Spatial((math.inf, 0.0, 0.0), (0.0, 0.0, 0.0))).turn).any()
