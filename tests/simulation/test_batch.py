"""A batch: each body to the bit as it is alone, whatever becomes of its neighbours; states and bad input."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bodies import make_body, random_damping, random_inertia, random_quaternion
from support.different_scenes import different_scenes
from support.sweeps import sweep

from dq_marine.algebra.dual_quaternion import pose_position
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.errors import StepNotSolvableError
from dq_marine.integrator.drift import MAX_PIECES
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.scene import Scene, batch_of

CURRENT = (0.2, -0.1, 0.05)
seeds = st.integers(0, 2**32 - 1)


def wave(parameters, pose, time):
    push = (parameters[0] * math.cos(parameters[1] * time), 0.0, 0.0)
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, push))


def brake(parameters, pose, twist, time):
    strength = -parameters[0] * abs(1.0 + pose_position(pose)[2])
    return Spatial(scale(strength, twist.angular), scale(strength, twist.linear))


def cliff(parameters, pose, time):
    """Nothing this side of a place, infinite beyond."""
    fall = math.exp(parameters[0] * (pose_position(pose)[0] - 1000.0))
    return Spatial((0.0, 0.0, 0.0), (0.0, 0.0, fall))


FORCES = (
    ForceTerm("wave", wave, (3.0, 2.0)),
    ForceTerm("cliff", cliff, (1e4,)),
    ForceTerm("brake", brake, (0.5,), uses_velocity=True),
)
GRAVITY = {"excess_weight": 2.0, "arm": (0.2, -0.1, 1.0)}
LINEAR = random_damping(np.random.default_rng(1))
QUADRATIC = (3.0, 5.0, 4.0, 1.0, 2.0, 1.5)
CASES = {
    "inertia alone": {},
    "order 4, damped": {"order": 4, "linear": np.eye(6), "quadratic": QUADRATIC},
    "order 6, paper": {"order": 6, "scheme": "paper", "current": CURRENT, **GRAVITY},
    "order 4, forces": {"order": 4, "forces": FORCES},
    "galerkin, free": {"order": 8, "scheme": "galerkin", "current": CURRENT},
    "galerkin, everything": {
        "order": 4,
        "scheme": "galerkin",
        "forces": FORCES,
        "quadratic": QUADRATIC,
        **GRAVITY,
    },
    "implicit node": {"l_stable": False, "linear": LINEAR, "quadratic": QUADRATIC},
    "runge_kutta, free": {"order": 8, "scheme": "runge_kutta", "current": CURRENT},
    "runge_kutta of order 4, forces": {
        "order": 4,
        "scheme": "runge_kutta",
        "forces": FORCES[:2],
        **GRAVITY,
    },
    "runge_kutta, forces": {"order": 8, "scheme": "runge_kutta", "forces": FORCES[:2], **GRAVITY},
    "gauss, free": {"order": 8, "scheme": "gauss", "current": CURRENT},
    "gauss of order 6, free": {"order": 6, "scheme": "gauss", "current": CURRENT},
    "gauss, damped": {
        "order": 8,
        "scheme": "gauss",
        "linear": LINEAR,
        "quadratic": QUADRATIC,
        **GRAVITY,
    },
    "gauss, forces": {"order": 8, "scheme": "gauss", "forces": FORCES[:2], **GRAVITY},
}

PLAIN_CASES = ("inertia alone",)


def batch_like(bodies, **options):
    """A batch of bodies like the given ones."""
    first = bodies[0]
    parameters = [body.parameters for body in bodies]
    return Batch(first._composition, parameters, first.step_size, len(bodies), **options)


def bodies_with_inertias(rng, count, step=0.02, **case):
    """Bodies of a case that differ in M."""
    return [make_body(random_inertia(rng), step, **case) for _ in range(count)]


def place(batch, singles, *rows):
    """Place a batch's bodies and single ones alike."""
    batch.reset(*rows)
    for single, state in zip(singles, batch.get_state(), strict=False):
        single.set_state(state)


def scatter(rng, batch, singles=(), speed=0.5):
    """Place bodies anywhere."""
    quaternions, vectors = random_quaternions(rng, batch.size), rng.normal(size=(batch.size, 9))
    place(batch, singles, vectors[:, :3], quaternions, speed * vectors[:, 3:])


def random_quaternions(rng, count):
    return np.array([random_quaternion(rng) for _ in range(count)])


def along_x(speeds):
    return np.outer(speeds, np.eye(6)[0])


def states_of(singles):
    return np.array([single.get_state() for single in singles])


def assert_fly_alike(rng, batch, singles, calls=((None, 1), (6.0, 3), (3.0, 1), (0.5, 10))):
    """Fly under wrenches of some size, the same for all if it is None; a number of steps in each call."""
    for size, steps in calls:
        wrenches = np.ones(6) if size is None else size * rng.normal(size=(batch.size, 6))
        batch.step(wrenches, steps)
        for single, wrench in zip(singles, np.broadcast_to(wrenches, (batch.size, 6)), strict=True):
            single.step(wrench, steps)
        assert np.array_equal(batch.get_state(), states_of(singles))
    assert batch.time == singles[0].time > 0.0
    assert batch.refusals == {}
    assert batch.steps_refused == 0


# Each body as it is alone


@pytest.mark.parametrize(("size", "threads"), [(7, 2), (19, 1), (19, 2)])
@pytest.mark.parametrize("name", sweep(CASES, plain=PLAIN_CASES))
def test_bodies_that_differ_in_inertia_move_as_each_alone(name, size, threads):
    rng = np.random.default_rng(size)
    singles = bodies_with_inertias(rng, size, **CASES[name])
    batch = batch_like(singles, threads=threads)
    assert batch.threads == min(threads, -(-size // 8))
    scatter(rng, batch, singles)
    assert_fly_alike(rng, batch, singles)
    batch.close()


@pytest.mark.parametrize(("size", "threads"), [(1, 1), (19, 2), (40, 3)])
def test_bodies_in_one_scene_move_as_each_alone(size, threads):
    rng, scene = np.random.default_rng(size), Scene(current=CURRENT)
    batch, singles = scene.batch(size, threads=threads), [scene.stepper() for _ in range(size)]
    scatter(rng, batch, singles)
    assert_fly_alike(rng, batch, singles)
    batch.close()


@pytest.mark.parametrize(("size", "threads"), [(7, 1), (19, 2)])
def test_vehicles_in_waters_of_their_own_move_as_each_alone(size, threads):
    rng, scenes = np.random.default_rng(size), different_scenes()[:size]
    batch, singles = batch_of(scenes, threads=threads), [scene.stepper() for scene in scenes]
    scatter(rng, batch, singles)
    assert_fly_alike(rng, batch, singles)
    for name in ("position_ned", "quaternion_body_to_ned", "velocity_body", "relative_velocity_body"):
        assert np.array_equal(getattr(batch, name), [getattr(single, name) for single in singles]), name
    batch.close()


# Other precision and arithmetic


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("precision", "arithmetic", "rounding"),
    [("float64", "fast", 2.0**-53), ("float32", "strict", 2.0**-24)],
)
def test_other_arithmetic_differs_by_round_off(precision, arithmetic, rounding):
    """100 steps, each of which adds some two roundings of numbers below 16; damping does not let them grow."""
    rng = np.random.default_rng(5)
    bodies = bodies_with_inertias(rng, 19, **CASES["implicit node"])
    strict, other = batch_like(bodies), batch_like(bodies, precision=precision, arithmetic=arithmetic)
    scatter(rng, strict)
    other.set_state(strict.get_state())
    for wrenches in 3.0 * rng.normal(size=(10, 19, 6)):
        strict.step(wrenches, 10)
        other.step(wrenches, 10)
    difference = np.abs(other.get_state() - strict.get_state()).max()
    assert 0.0 < difference < 100 * 2 * 16 * rounding
    assert other.refusals == {}


# Bodies that the integrator has trouble with

SPHEROID = np.diag([35.39387824, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877])
STEP_LIMIT = 2.0 / 2.301752703506763
"""Speed [m/s] at which a step of 1 s leaves the branch; at `MAX_PIECES` times as much its smallest pieces do."""


def step_alone(singles, wrenches, steps):
    """Step each body; return why some refused, by index."""
    refusals = {}
    for index, (single, wrench) in enumerate(zip(singles, wrenches, strict=True)):
        try:
            single.step(wrench, steps)
        except StepNotSolvableError as error:
            refusals[index] = error.reason
    return refusals


def assert_fare_alike(batch, singles, wrenches, steps):
    """Step all, and return why some refused; these stay where they were, though time goes on for all."""
    refused = batch.steps_refused
    batch.step(wrenches, steps)
    refusals = step_alone(singles, wrenches, steps)
    assert batch.refusals == refusals
    assert batch.steps_refused == refused + len(refusals)
    assert np.array_equal(batch.get_state()[:, 1:], states_of(singles)[:, 1:])
    for single in singles:
        single.time = batch.time
    return refusals


def test_neighbours_of_extreme_bodies_do_not_notice():
    rng, calm = np.random.default_rng(3), 0.1 * np.random.default_rng(4).normal(size=(19, 6))
    bodies = [*(make_body(SPHEROID, 1.0) for _ in range(18)), make_body(random_inertia(rng), 1.0)]
    extreme = calm.copy()
    extreme[[3, 8, 17]] = along_x(STEP_LIMIT * np.array([1.05, 1.01 * MAX_PIECES, 2.0 * MAX_PIECES]))
    batch, without = batch_like(bodies), batch_like(bodies)
    batch.reset(velocity_body=extreme)
    without.reset(velocity_body=calm)
    start, ordinary = batch.get_state()[:, 1:], np.delete(np.arange(19), [3, 8, 17])
    for calls in (1, 2, 3):
        wrenches = 0.1 * rng.normal(size=(19, 6))
        wrenches[[8, 17]] = 0.0
        for one in (batch, without):
            one.step(wrenches, 2)
        assert np.array_equal(batch.get_state()[ordinary], without.get_state()[ordinary])
        assert np.array_equal(batch.get_state()[[8, 17], 1:], start[[8, 17]])
        assert batch.refusals == {8: "wrong_branch", 17: "wrong_branch"}
        assert (batch.steps_refused, without.steps_refused) == (2 * calls, 0)


def test_a_step_refused_in_the_middle_of_a_call_undoes_the_call():
    """Thrust takes one body beyond the limit in the third step of a call, another in the fourth of the next."""
    singles = [make_body(SPHEROID, 1.0) for _ in range(9)]
    singles[8] = make_body(random_inertia(np.random.default_rng(0)), 1.0)
    batch, speeds = batch_like(singles), np.zeros(9)
    speeds[[2, 5, 6]] = MAX_PIECES * STEP_LIMIT - np.array([12.0, 4.0, 30.0])
    place(batch, singles, np.zeros(3), np.eye(4)[0], along_x(speeds))
    wrenches = along_x(2.0 * SPHEROID[0, 0] * (np.arange(9) % 8 > 0))
    assert assert_fare_alike(batch, singles, wrenches, 3) == {5: "wrong_branch"}
    assert assert_fare_alike(batch, singles, wrenches, 4) == {2: "wrong_branch", 5: "wrong_branch"}
    assert assert_fare_alike(batch, singles, -wrenches, 3) == {}


@pytest.mark.sweep
def test_a_body_whose_force_overflows_is_refused():
    rng, here = np.random.default_rng(6), np.arange(9)[:, None] == 4
    singles = bodies_with_inertias(rng, 9, **CASES["order 4, forces"])
    batch = batch_like(singles)
    positions = np.where(here, (999.9, 0.0, 0.0), rng.normal(size=(9, 3)))
    place(batch, singles, positions, np.eye(4)[0], np.where(here, along_x([10.0]), rng.normal(size=(9, 6))))
    assert assert_fare_alike(batch, singles, np.zeros((9, 6)), 1) == {4: "not_finite"}


@settings(max_examples=20)
@given(seeds, st.floats(-1.0, 2.0))
def test_extreme_bodies_fare_as_each_alone(seed, log_speed):
    """Solved, solved by the fallback or refused: with the same bits."""
    rng = np.random.default_rng(seed)
    singles = bodies_with_inertias(rng, 11, 0.5)
    batch = batch_like(singles)
    scatter(rng, batch, singles, 10.0 ** rng.uniform(-2.0, log_speed, (11, 1)))
    for steps in (1, 3, 2):
        wrenches = 10.0 ** rng.uniform(-2.0, 2.0, (11, 1)) * rng.normal(size=(11, 6))
        assert_fare_alike(batch, singles, wrenches, steps)


def test_fallbacks_are_counted_as_for_each_alone():
    """A call that was refused counts none."""
    rng = np.random.default_rng(95)
    singles = bodies_with_inertias(rng, 11, 0.5)
    batch = batch_like(singles)
    scatter(rng, batch, singles, 10.0 ** rng.uniform(-1.0, 2.0, (11, 1)))
    for steps in (1, 3, 2):
        assert_fare_alike(batch, singles, np.zeros((11, 6)), steps)
        assert batch.steps_refused > 0
        assert batch.fallback_steps == sum(single.fallback_steps for single in singles) > 0


@pytest.mark.parametrize("precision", sweep(["float64", "float32"], plain=["float64"]))
def test_bodies_of_revolution_are_told_to_be_on_the_wrong_branch(precision):
    """Beyond the limit two eigenvalues of theirs have crossed zero together: a double root, known but for round-off."""
    body, speeds = make_body(SPHEROID, 1.0), STEP_LIMIT * np.linspace(0.02, 7.5, 400)
    batch = Batch(body._composition, [body.parameters], 1.0, 400, precision=precision)
    attitudes = random_quaternions(np.random.default_rng(0), 400)
    batch.reset(quaternion_body_to_ned=attitudes, velocity_body=along_x(speeds))
    batch.step()
    assert batch.refusals == {}
    assert batch.fallback_steps == np.count_nonzero(speeds > STEP_LIMIT)


def test_free_bodies_keep_momentum_and_energy():
    rng = np.random.default_rng(8)
    singles = bodies_with_inertias(rng, 19)
    batch = batch_like(singles)
    scatter(rng, batch)
    momentum, energy = [], []
    for _ in range(10):
        momentum.append(batch.spatial_momentum)
        energy.append(batch.kinetic_energy)
        batch.step(steps=100)
    assert np.abs(np.array(momentum) - momentum[0]).max() < 1e-12 * np.abs(momentum[0]).max()
    assert (np.abs(np.array(energy) - energy[0]) < 0.01 * energy[0]).all()


# States and doors


def test_a_state_is_restored_bit_for_bit():
    rng, scene = np.random.default_rng(9), Scene(current=CURRENT)
    batch, other, wrenches = scene.batch(7), scene.batch(7), rng.normal(size=(7, 6))
    scatter(rng, batch)
    batch.step(wrenches, 13)
    other.set_state(batch.get_state())
    assert other.time == batch.time == pytest.approx(0.26)
    for one in (batch, other):
        one.step(wrenches, 29)
    assert np.array_equal(batch.get_state(), other.get_state())
    assert batch.get_state().shape == (7, 15)


@given(seeds)
def test_bodies_are_placed_by_rows_as_each_alone(seed):
    rng, scene = np.random.default_rng(seed), Scene(current=CURRENT)
    unit = random_quaternions(rng, 11) * (1.0 + 1e-7 * rng.normal(size=(11, 1)))
    rows = rng.normal(size=(11, 3)), unit, rng.normal(size=(11, 6))
    batch, single = scene.batch(11), scene.stepper()
    batch.reset(*rows)
    for body, row in enumerate(zip(*rows, strict=True)):
        single.reset(*row)
        assert np.array_equal(batch.get_state()[body], single.get_state())
    assert np.allclose(batch.velocity_body, rows[2], rtol=0, atol=1e-14)
    batch.reset(rows[0][0], velocity_body=rows[2])
    assert np.allclose(batch.position_ned, rows[0][0], rtol=0, atol=1e-14)
    assert np.allclose(batch.velocity_body, rows[2], rtol=0, atol=1e-14)
    assert np.array_equal(batch.quaternion_body_to_ned, [(1.0, 0.0, 0.0, 0.0)] * 11)
    assert batch.time == 0.0
