"""The vector environment's contract: making it, spaces, what goes into a step and comes out, its environments."""

import copy
import json
from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from support.environments import StationKeepingEnv
from support.sweeps import sweep
from support.vector_envs import BUSY, reference, same, states

import dq_marine  # noqa: F401 - registers
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.vector.vector_env import MarineVectorEnv
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/StationKeeping-v0"


def actions_for(envs, seed=0, periods=None, scale=1.0):
    shape = envs.action_space.shape if periods is None else (periods, *envs.action_space.shape)
    return np.random.default_rng(seed).uniform(-scale, scale, shape).astype(np.float32)


# Making


def test_make_vec_gives_the_compiled_vector_environment(envs):
    assert isinstance(envs, MarineVectorEnv)
    assert isinstance(envs, gym.vector.VectorEnv)
    assert envs.num_envs == 8
    assert envs.unwrapped is envs
    assert not envs.closed
    assert envs.spec.id == ID
    assert repr(envs) == f"{type(envs).__name__}({ID}, num_envs=8)"
    assert type(gym.make_vec(ID, num_envs=2, vectorization_mode="sync")) is SyncVectorEnv


def test_its_spec_makes_another_like_it():
    keywords = {"current": [0.1, 0.2, 0.0], "reward": {"effort": 0.1}, "autoreset_mode": "SameStep"}
    first = gym.make_vec(ID, num_envs=3, max_episode_steps=2, **json.loads(json.dumps(keywords)))
    second = gym.make_vec(first.spec)
    assert second.num_envs == 3
    assert second.metadata == first.metadata
    for envs in (first, second):
        envs.reset(seed=4)
    for actions in actions_for(first, periods=3):
        assert same(first.step(actions), second.step(actions))


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("mode", AutoresetMode)
@pytest.mark.parametrize("axes", [6, 3])
def test_spaces_and_metadata_are_those_of_single_environments(count, mode, axes):
    vehicle = load_vehicle("bluerov2_heavy")
    if axes == 3:
        limits = vehicle.limits.model_copy(update={"wrench": (100.0, 0.0, 100.0, 0.0, 0.0, 30.0)})
        vehicle = vehicle.model_copy(update={"limits": limits})
    keywords = {"vehicle": vehicle, "workspace_radius": 3.0, "control_period": 0.2}
    envs = gym.make_vec(ID, num_envs=count, autoreset_mode=mode, **keywords)
    gymnasiums, single = reference(count, mode, **keywords), StationKeepingEnv(**keywords)
    assert envs.single_action_space == single.action_space
    assert envs.single_action_space.shape == (axes,)
    assert envs.single_observation_space == single.observation_space
    assert envs.action_space == gymnasiums.action_space
    assert envs.observation_space == gymnasiums.observation_space
    assert envs.metadata == gymnasiums.metadata
    assert envs.metadata["autoreset_mode"] is mode
    assert envs.render_mode is None
    assert "autoreset_mode" not in MarineEnv.metadata


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"num_envs": 0}, "num_envs"),
        ({"max_episode_steps": 0}, "max_episode_steps"),
        ({"max_episode_steps": 2.5}, "max_episode_steps"),
        ({"autoreset_mode": "sometimes"}, "autoreset_mode"),
        ({"threads": 0}, "threads"),
        ({"threads": 1.5}, "threads"),
        ({"arithmetic": "quick"}, "arithmetic"),
        ({"precision": "float16"}, "precision"),
        ({"current": -0.1}, "current"),
        ({"substeps": 0}, "substeps"),
        ({"reward": {"speed": 1.0}}, "speed"),
        ({"start_radius": 9.0}, "start_radius"),
        ({"render_mode": "ascii"}, "render_mode"),
        ({"vehicle": "my.toml"}, "my.toml"),
    ],
)
def test_wrong_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidInputError, match=message):
        gym.make_vec(ID, **{"num_envs": 2, **keywords})


def test_nothing_is_recorded():
    with pytest.raises((InvalidInputError, TypeError), match="record"):
        gym.make_vec(ID, num_envs=2, record=True)


# Step


def test_actions_are_taken_in_any_form_and_saturate(envs):
    actions = actions_for(envs, scale=3.0)
    expected = envs.step(actions)
    wide = np.zeros((16, 12), dtype=np.float64)
    wide[::2, ::2] = actions
    forms = [actions.astype(np.float64), wide[::2, ::2], np.asfortranarray(actions), actions.tolist()]
    for form in [*forms, np.clip(actions, -1.0, 1.0)]:
        given = copy.deepcopy(form)
        envs.reset(seed=0)
        observations, rewards, *_ = envs.step(form)
        assert same(form, given)
        assert same((observations, rewards), expected[:2])


@pytest.mark.parametrize(
    "wrong",
    [np.zeros((8, 5)), np.zeros((7, 6)), np.zeros(48), np.zeros(6), np.zeros((8, 6, 1)), 0.0, "ahead", None],
)
def test_actions_of_a_wrong_shape_are_refused_and_change_nothing(envs, wrong):
    envs.step(actions_for(envs))
    before = states(envs)
    with pytest.raises(InvalidInputError, match="action"):
        envs.step(wrong)
    assert same(states(envs), before)


@pytest.mark.parametrize(
    "values", [(np.nan, np.nan), (np.inf, np.inf), (-np.inf, np.inf), (np.inf, np.nan)], ids=str
)
def test_an_action_that_is_not_finite_is_refused_naming_its_environment(envs, values):
    twin = gym.make_vec(ID, num_envs=8)
    twin.reset(seed=0)
    before = states(envs)
    actions = np.zeros((8, 6))
    actions[5, 3], actions[7, 1] = values
    with pytest.raises(InvalidInputError, match=r"action.*\b5\b"):
        envs.step(actions)
    assert same(states(envs), before)
    for good in actions_for(envs, periods=3):
        assert same(envs.step(good), twin.step(good))


def test_the_largest_finite_actions_saturate_too(envs):
    """Their sum overflows; they are finite all the same."""
    expected = envs.step(np.ones((8, 6)))
    for largest in (np.float32(3e38), np.float64(1.7e308)):
        envs.reset(seed=0)
        assert same(envs.step(np.full((8, 6), largest)), expected)


def test_nothing_works_before_reset():
    envs = gym.make_vec(ID, num_envs=2)
    for call in (partial(envs.step, np.zeros((2, 6))), partial(envs.call, "get_state")):
        with pytest.raises(ResetNeeded, match="reset"):
            call()


def test_attributes_that_need_no_episode_are_there_before_reset():
    envs = gym.make_vec(ID, num_envs=2, control_period=0.2)
    assert envs.get_attr("control_period") == (0.2, 0.2)
    assert envs.get_attr("render_mode") == (None, None)
    with pytest.raises(ResetNeeded, match="reset"):
        envs.get_attr("position_ned")


def arrays_in(result):
    if isinstance(result, np.ndarray):
        return [result]
    parts = result.values() if isinstance(result, dict) else result
    return [array for part in parts for array in arrays_in(part)]


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_what_is_returned_is_the_callers_own(mode):
    envs = gym.make_vec(ID, num_envs=3, autoreset_mode=mode, **BUSY)
    twin = gym.make_vec(ID, num_envs=3, autoreset_mode=mode, **BUSY)
    results, kept = [envs.reset(seed=0)], []
    twin.reset(seed=0)
    for actions in actions_for(envs, periods=20):
        kept.append(copy.deepcopy(results[-1]))
        results.append(envs.step(actions))
        assert same(results[-1], twin.step(actions))
        for array in arrays_in(results[-1]):
            assert array.flags.writeable
    assert all(same(result, copied) for result, copied in zip(results, kept, strict=False))
    for array in arrays_in(tuple(results)):
        array[...] = 1
    assert same(states(envs), states(twin))
    assert same(envs.step(np.zeros((3, 6))), twin.step(np.zeros((3, 6))))


def test_without_copies_the_values_are_the_same():
    envs = gym.make_vec(ID, num_envs=3, copy=False, **BUSY)
    twin = gym.make_vec(ID, num_envs=3, **BUSY)
    assert same(envs.reset(seed=0), twin.reset(seed=0))
    for actions in actions_for(envs, periods=20):
        assert same(envs.step(actions), twin.step(actions))


# Its environments

ATTRIBUTES = (
    "position_ned", "quaternion_body_to_ned", "velocity_body", "time", "observation", "fallback_substeps",
    "substeps", "control_period", "workspace_radius", "goal_position", "current_draw",
)  # fmt: skip


def test_attributes_and_calls_are_those_of_separate_environments():
    envs, gymnasiums = gym.make_vec(ID, num_envs=3, **BUSY), reference(3, **BUSY)
    for each in (envs, gymnasiums):
        each.reset(seed=0)
    for actions in actions_for(envs, periods=20):
        for each in (envs, gymnasiums):
            each.step(actions)
        for name in ATTRIBUTES:
            assert same(envs.get_attr(name), gymnasiums.get_attr(name)), name
        assert same(envs.call("get_state"), gymnasiums.call("get_state"))
    assert same(envs.call("substeps"), (4, 4, 4))
    with pytest.raises(AttributeError, match="nonsense"):
        envs.get_attr("nonsense")
    with pytest.raises(AttributeError, match="nonsense"):
        envs.call("nonsense", 1)


SETTINGS = {
    "one value for all": {"start_radius": 0.5, "goal_position": np.array([1.0, 2.0, 6.0])},
    "one for each": {"start_radius": [0.0, 0.5, 4.0], "goal_position": tuple(np.eye(3))},
    "generators": {"np_random": [np.random.default_rng(seed) for seed in (7, 8, 9)]},
    "names of the caller's": {"label": ["a", "b", "c"], "note": "d"},
}


@pytest.mark.parametrize("settings", sweep(SETTINGS, plain=["one value for all", "generators"]))
def test_setting_attributes_acts_on_the_next_episodes(settings):
    envs, gymnasiums = gym.make_vec(ID, num_envs=3), reference(3)
    for each in (envs, gymnasiums):
        each.reset(seed=0)
        for name, values in copy.deepcopy(SETTINGS[settings]).items():
            each.set_attr(name, values)
    for name in SETTINGS[settings]:
        if name != "np_random":
            assert same(envs.get_attr(name), gymnasiums.get_attr(name)), name
    assert same(envs.reset(), gymnasiums.reset())
    for actions in actions_for(envs, periods=3):
        assert same(envs.step(actions), gymnasiums.step(actions))


def test_setting_an_attribute_takes_one_value_or_one_for_each():
    envs = gym.make_vec(ID, num_envs=3)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match="2"):
        envs.set_attr("start_radius", [0.1, 0.2])
    assert envs.get_attr("start_radius") == (2.0, 2.0, 2.0)


def test_states_travel_between_vector_and_single_environments():
    envs, single = gym.make_vec(ID, num_envs=3), StationKeepingEnv()
    envs.reset(seed=0)
    single.reset(seed=77)
    actions = actions_for(envs, periods=12)[:, [0, 0, 0]]
    for action in actions[:6]:
        single.step(action[0])
    envs.call("set_state", single.get_state())
    for action in actions[6:]:
        observations, rewards, *_ = envs.step(action)
        observation, reward, *_ = single.step(action[0])
        assert all(same(row, observation) for row in observations)
        assert rewards.tolist() == [reward] * 3
    single.set_state(envs.call("get_state")[2])
    assert same(envs.reset()[0][2], single.reset()[0])


def test_vector_environments_do_not_disturb_each_other():
    one, two, alone = (gym.make_vec(ID, num_envs=3, **BUSY) for _ in range(3))
    one.reset(seed=0)
    two.reset(seed=1)
    flown = []
    for actions in actions_for(one, periods=12):
        flown.append(one.step(actions))
        two.step(-actions)
    alone.reset(seed=0)
    assert same(flown, [alone.step(actions) for actions in actions_for(one, periods=12)])


def test_closing_twice_is_closing():
    envs = gym.make_vec(ID, num_envs=2)
    envs.reset(seed=0)
    envs.close()
    assert envs.closed
    envs.close()
    gym.make_vec(ID, num_envs=2).close()  # before any reset


@pytest.mark.sweep
@pytest.mark.browser
def test_pictures_come_one_for_each_environment():
    envs = gym.make_vec(ID, num_envs=2, render_mode="rgb_array", current=0.0)
    assert envs.render_mode == "rgb_array"
    with pytest.raises(ResetNeeded):
        envs.render()
    envs.reset(seed=0)
    pictures = envs.render()
    assert isinstance(pictures, tuple)
    assert [picture.dtype for picture in pictures] == [np.uint8] * 2
    assert pictures[0].shape == pictures[1].shape
    assert (pictures[0] != pictures[1]).any()
    envs.close()
