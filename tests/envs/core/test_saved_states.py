"""A state that comes in from outside is restored whole or refused whole, whatever was done to it."""

import numpy as np
import pytest
from support.environments import StationKeepingEnv

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene


@pytest.fixture(scope="module")
def module_env():
    return StationKeepingEnv()


@pytest.fixture
def env(module_env):
    module_env.reset(seed=0)
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (3, 6)):
        module_env.step(action)
    return module_env


def test_what_is_foreseen_comes_true_and_changes_nothing(env):
    before = env.get_state()
    ahead = env.foreseen(np.full(6, 0.3))
    after = env.get_state()
    assert all(np.array_equal(before[name], after[name]) for name in before if name != "random")
    assert before["random"] == after["random"]
    env.step(np.full(6, 0.3))
    assert ahead == env.motion


@pytest.mark.sweep
def test_what_is_foreseen_takes_the_random_numbers_that_the_step_will_take():
    env = StationKeepingEnv(sensors="auv", current={"mean": [0.2, 0.0, 0.0], "standard_deviation": 0.2})
    env.reset(seed=0)
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (20, 6)):
        ahead = env.foreseen(action)
        env.step(action)
        assert ahead == env.motion


def changed(state, name, change):
    return state | {
        name: change(np.array(state[name]) if isinstance(state[name], np.ndarray) else state[name])
    }


def with_entry(index, value):
    def change(array):
        array[index] = value
        return array

    return change


def across(state):
    """The dual part moved along the real part, to which it must be orthogonal."""
    state[4:8] += 0.1 * state[:4]
    return state


def scaled_attitude(factor):
    def change(state):
        state[:4] *= factor
        return state

    return change


WRONG = {
    "a doubled quaternion": ("state", scaled_attitude(2.0), "unit quaternion"),
    "a zero quaternion": ("state", scaled_attitude(0.0), "unit quaternion"),
    "a wrong dual part": ("state", across, "dual quaternion"),
    "a huge momentum": ("state", with_entry(10, 1e200), "1e\\+200"),
    "a NaN": ("state", with_entry(3, np.nan), "not finite"),
    "parameters of zero": ("parameters", lambda array: 0.0 * array, "another vehicle"),
    "twice the inertia": ("parameters", lambda array: 2.0 * array, "another vehicle"),
    "no limits": ("episode_parameters", lambda array: 0.0 * array, "must be positive"),
    "huge parameters": ("episode_parameters", lambda array: 0.0 * array + 1e200, "1e\\+200"),
    "a memory of infinities": ("memory", lambda array: array + np.inf, "not finite"),
    "an action beyond its limits": ("action", lambda array: array + 3.0, "beyond"),
    "an observation beyond its space": ("observation", lambda array: array + 1e30, "observation space"),
    "negative periods": ("periods", lambda periods: -5, "below 0"),
    "half a period": ("periods", lambda periods: 1.5, "not an integer"),
    "no such vehicle": ("vehicle", lambda number: 7, "from 0 to 0"),
    "a clock before the beginning": ("clock", lambda clock: -1.0, "at least 0"),
    "text": ("clock", lambda clock: "noon", "not numeric"),
    "a generator of another kind": ("random", lambda saved: {"bit_generator": "MT19937"}, "generator"),
    "a generator with a number too large": (
        "random",
        lambda saved: saved | {"state": {"state": 2**200, "inc": 1}},
        "generator",
    ),
}


@pytest.mark.parametrize(("name", "change", "message"), WRONG.values(), ids=WRONG.keys())
def test_a_state_that_cannot_be_is_refused_and_changes_nothing(env, name, change, message):
    before = env.get_state()
    with pytest.raises(InvalidInputError, match=message):
        env.set_state(changed(before, name, change))
    after = env.get_state()
    assert str(after["random"]) == str(before["random"])
    for key in set(before) - {"random"}:
        assert np.array_equal(after[key], before[key]), key


@pytest.mark.parametrize(
    "state", [None, [], {}, {"random": 1}, {1: 2, "a": 3}], ids=["none", "list", "empty", "one", "mixed keys"]
)
def test_what_is_no_state_at_all_is_refused(env, state):
    with pytest.raises(InvalidInputError, match="needs the entries"):
        env.set_state(state)


def test_an_unknown_entry_is_refused(env):
    with pytest.raises(InvalidInputError, match="needs the entries"):
        env.set_state(env.get_state() | {"mass": 1.0})


@pytest.mark.parametrize("number", [1, 3], ids=["alone", "in a batch"])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows * 2.0, "unit quaternion"),
        (lambda rows: rows * 0.0, "unit quaternion"),
        (lambda rows: rows + 0.1 * np.roll(rows, 4, axis=-1) * (np.arange(15) // 4 == 1), "dual quaternion"),
        (lambda rows: rows + 1e200 * (np.arange(15) == 12), "1e\\+200"),
        (lambda rows: rows + 1e200 * (np.arange(15) == 0), "1e\\+200"),
    ],
    ids=["doubled", "zero", "dual part", "momentum", "time"],
)
def test_bodies_refuse_such_states_too(number, change, message):
    scene = Scene()
    body = scene.stepper() if number == 1 else scene.batch(number, threads=1)
    body.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), np.full(6, 0.1))
    before = body.get_state()
    with pytest.raises(InvalidInputError, match=message):
        body.set_state(change(before))
    assert np.array_equal(body.get_state(), before)
    body.set_state(before)
