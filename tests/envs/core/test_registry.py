"""What every registered task promises, with the vehicles that it suits, and how tasks are registered."""

import copy
import dataclasses
import pickle
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from stable_baselines3.common.env_checker import check_env as check_env_for_sb3
from support.environments import STATION_KEEPING, WAYPOINT_TRACKING
from support.suited import SUITED
from support.sweeps import sweep

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.module_task import define_task
from dq_marine.envs.core.registry import (
    register_task,
    shipped_tasks,
    short_name,
    task_named,
    unregister_task,
)
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle

OWN = [task.id for task in shipped_tasks()]
PLAIN = [(STATION_KEEPING, "bluerov2_heavy"), (WAYPOINT_TRACKING, "bluerov2_heavy")]
each_suited = pytest.mark.parametrize(("task", "vehicle"), sweep(SUITED, plain=PLAIN))
STEPS = 1000
WITHOUT_SCENERY = ("DepthHeading", "DynamicPositioning", "StationKeeping")
"""Tasks with nothing around the vehicle but water."""


def random_flight(env, steps):
    """Observations, rewards and ends of a flight with random actions, begun anew where an episode ends."""
    rng = np.random.default_rng(0)
    observation, info = env.reset(seed=0)
    yield observation, 0.0, False, False, info
    for _ in range(steps):
        outcome = env.step(rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32))
        yield outcome
        if outcome[2] or outcome[3]:
            env.reset()


@each_suited
def test_the_checkers_of_gymnasium_and_sb3_pass(task, vehicle):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gym.make(task, vehicle=vehicle).unwrapped
        check_env(env, skip_render_check=True)
        check_env_for_sb3(env)


@each_suited
def test_random_flights_stay_finite_and_within_their_spaces(task, vehicle):
    env = gym.make(task, vehicle=vehicle)
    inner = env.unwrapped
    for observation, reward, terminated, _, info in random_flight(env, STEPS):
        assert env.observation_space.contains(observation)
        assert np.isfinite(reward)
        assert isinstance(terminated, bool)
        assert all(np.isfinite(value).all() for value in info.values())
    assert inner.refusal is None
    assert sum(one.size for one in inner.observations) == env.observation_space.shape[0]
    names = [one.name for one in inner.observations]
    assert len(set(names)) == len(names)
    assert all(one.meaning and one.bound > 0.0 for one in inner.observations)


@each_suited
def test_the_reward_is_the_sum_of_its_terms(task, vehicle):
    env = gym.make(task, vehicle=vehicle)
    terms = [f"reward/{name}" for name in task_named(task).reward_names]
    for _, reward, _, _, info in list(random_flight(env, 50))[1:]:
        assert reward == pytest.approx(sum(float(info[term]) for term in terms), rel=1e-12, abs=1e-12)


@each_suited
def test_it_travels_in_mid_episode(task, vehicle):
    env = gym.make(task, vehicle=vehicle)
    list(random_flight(env, 5))
    twins = [pickle.loads(pickle.dumps(env)), copy.deepcopy(env)]
    action = np.full(env.action_space.shape, 0.3, np.float32)
    own = env.step(action)
    for twin in twins:
        observation, reward, *_ = twin.step(action)
        assert np.array_equal(observation, own[0])
        assert reward == own[1]


@each_suited
def test_an_episode_can_be_kept_and_shown(task, vehicle, tmp_path):
    env = gym.make(task, vehicle=vehicle, record=True).unwrapped
    env.reset(seed=0)
    for _ in range(5):
        env.step(np.zeros(env.action_space.shape, np.float32))
    assert env.snapshot().things or short_name(task_named(task)) in WITHOUT_SCENERY
    replay = tmp_path / "replay.html"
    env.save_html(replay)
    assert replay.stat().st_size > 10_000


def test_every_task_is_known_to_gymnasium_and_says_what_it_is():
    assert set(OWN) == {name for name in gym.registry if name.startswith("dq_marine/")}
    for task in map(task_named, OWN):
        assert task.summary.endswith(".")
        assert task.unsuitable(load_vehicle(task.vehicle)) is None
        assert set(task.units) <= set(task.metric_names)
        assert set(task.tolerances) <= set(task.metric_names)


# Registering

OTHER = "tests/Other-v0"


@pytest.fixture
def other():
    """A task with an id of its own, which the test may register."""
    definition = dataclasses.replace(task_named(STATION_KEEPING), id=OTHER)
    yield definition
    if OTHER in gym.registry:
        unregister_task(OTHER)


def test_a_module_may_register_its_task_again_but_no_other(other):
    """So that a cell of a notebook can be run twice."""
    register_task(other, "mine")
    register_task(dataclasses.replace(other, max_episode_steps=7), "mine")
    assert gym.make(OTHER).spec.max_episode_steps == 7
    with pytest.raises(InvalidInputError, match=rf"another task '{OTHER}', of mine; give yours"):
        register_task(dataclasses.replace(other, max_episode_steps=8), "theirs")
    assert task_named(OTHER).max_episode_steps == 7


def test_a_task_that_was_taken_away_is_unknown(other):
    register_task(other)
    env = gym.make(OTHER)
    env.reset(seed=0)
    unregister_task(OTHER)
    with pytest.raises(InvalidInputError, match=rf"no task '{OTHER}'"):
        unregister_task(OTHER)
    with pytest.raises(gym.error.Error):
        gym.make(OTHER)
    twin = pickle.loads(pickle.dumps(env.unwrapped))  # it takes its definition along
    action = np.zeros(env.action_space.shape, np.float32)
    assert np.array_equal(twin.step(action)[0], env.step(action)[0])


@pytest.mark.parametrize(
    ("absent", "message"),
    [("start", r"lacks \['start'\]"), ("Rewards", r"lacks \['Rewards'\]"), ("observations", "observations")],
)
def test_a_file_that_lacks_something_is_refused(absent, message):
    from dq_marine.envs.tasks import waypoint_tracking

    names = {name: value for name, value in vars(waypoint_tracking).items() if name != absent}
    with pytest.raises(InvalidInputError, match=message):
        define_task(names, id=OTHER, summary="It lacks something.", draws=0)
    assert OTHER not in gym.registry


@pytest.mark.parametrize(
    "changes",
    [
        {"observations": lambda settings, vehicle: "none"},
        {"parameters": lambda settings, context: {}},
    ],
    ids=["observations", "parameters"],
)
def test_a_task_of_wrong_parts_is_refused(other, changes):
    with pytest.raises((InvalidInputError, AttributeError)):
        MarineEnv(dataclasses.replace(other, **changes))
