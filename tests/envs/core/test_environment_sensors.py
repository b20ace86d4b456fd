"""Environments whose agent is told by sensors: what is told, what stays true, what is refused."""

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from support.environments import StationKeepingEnv

from dq_marine.errors import InvalidInputError
from dq_marine.task.sensors.build import (
    AHRS,
    AUV,
    DVL,
    GNSS,
    Accelerometer,
    DepthMeter,
    Gyroscope,
    sensors_of,
)
from dq_marine.vehicles import load_vehicle

ID = "dq_marine/StationKeeping-v0"
PERFECT = (
    Gyroscope(),
    DVL(),
    DepthMeter(),
    AHRS(),
    GNSS(rate=None, surface=100.0),
    Accelerometer(),
)
"""As many as there are, so that all tests here share one compilation."""


def imperfect(**errors):
    return tuple(
        type(one)(**({"rate": None, "surface": 100.0} if isinstance(one, GNSS) else {}), **errors)
        for one in PERFECT
    )


def flown(env, periods=15, seed=3):
    """Observation, reward, terminated, truncated, info of every period."""
    observation, info = env.reset(seed=seed)
    actions = np.random.default_rng(seed).uniform(-1.0, 1.0, (periods, 6)).astype(np.float32)
    return [(observation, 0.0, False, False, info), *map(env.step, actions)]


def observations(results):
    return np.array([result[0] for result in results])


def test_perfect_sensors_tell_what_an_agent_without_sensors_knows():
    bare, told = (flown(StationKeepingEnv(sensors=sensors)) for sensors in (None, PERFECT))
    assert np.array_equal(observations(told)[:, :18], observations(bare))
    extra = observations(told)[:, 18:]
    assert extra.shape[1] == 6 + 3
    assert not extra[:, :6].any(), "all readings are new"
    for (_, *a), (_, *b) in zip(bare, told, strict=True):
        assert data_equivalence(a, b, exact=True)


def test_an_accelerometer_feels_the_vehicles_gravity():
    env = StationKeepingEnv(load_vehicle("bluerov2_heavy").in_gravity(1.62), sensors=PERFECT)
    observation, _ = env.reset(seed=1)
    assert np.linalg.norm(observation[-3:]) == pytest.approx(1.62, rel=1e-6)


def test_rewards_measures_and_the_motion_are_those_of_the_truth():
    bare = StationKeepingEnv()
    env = StationKeepingEnv(sensors=imperfect(noise=0.3, bias=0.3, walk=0.1, scale=0.1, dropout=0.2))
    true, told = flown(bare), flown(env)
    assert not np.allclose(observations(told)[:, :18], observations(true), atol=0.05)
    for (_, *a), (_, *b) in zip(true, told, strict=True):
        assert data_equivalence(a, b, exact=True)
    assert np.array_equal(bare.velocity_body, env.velocity_body)


def test_observations_stay_within_their_space_whatever_the_errors():
    env = StationKeepingEnv(sensors=imperfect(noise=1e3, bias=1e3, walk=1e3, scale=1e3, dropout=0.5))
    for observation, *_ in flown(env, 30):
        assert env.observation_space.contains(observation)


def test_the_integral_of_the_error_is_that_of_the_measured_one():
    sensors = imperfect()
    sensors = [*sensors[:2], DepthMeter(bias=3.0), *sensors[3:]]
    env = StationKeepingEnv(sensors=sensors, goal_position=(0.0, 0.0, 5.0))
    env.reset(seed=1, options={"position": (0.0, 0.0, 5.0), "velocity": (0.0,) * 6, "current": (0.0,) * 3})
    bias = env.observation[2]
    for k in range(3):
        observation = env.step(np.zeros(6, np.float32))[0]
        turned = np.linalg.norm(observation[15:18])
        assert turned == pytest.approx(abs(bias) * 0.1 * (k + 1), rel=0.05)


def test_states_are_restored_with_the_sensors():
    sensors = imperfect(noise=0.1, bias=0.1, walk=0.1, dropout=0.5)
    env, other = (StationKeepingEnv(sensors=sensors) for _ in range(2))
    flown(env, 5)
    other.set_state(env.get_state())
    assert np.array_equal(other.observation, env.observation)
    for _ in range(5):
        results = [each.step(np.ones(6, np.float32)) for each in (env, other)]
        assert data_equivalence(*results, exact=True)


def test_an_episode_follows_from_its_seed():
    sensors = imperfect(noise=0.1, dropout=0.5)
    flights = [flown(StationKeepingEnv(sensors=sensors), seed=seed) for seed in (3, 3, 4)]
    assert data_equivalence(flights[0], flights[1], exact=True)
    assert not np.array_equal(observations(flights[0]), observations(flights[2]))


@pytest.mark.sweep
def test_many_told_by_sensors_are_those_told_alone():
    sensors = imperfect(noise=0.1, bias=0.1, walk=0.1, scale=0.05, dropout=0.3)
    envs = gym.make_vec(ID, num_envs=9, sensors=sensors, max_episode_steps=8)
    singles = [gym.make(ID, sensors=sensors, max_episode_steps=8).unwrapped for _ in range(9)]
    told = envs.reset(seed=5)[0]
    alone = [env.reset(seed=5 + i)[0] for i, env in enumerate(singles)]
    assert np.array_equal(told, alone)
    random = np.random.default_rng(0)
    for period in range(1, 20):
        actions = random.uniform(-1.0, 1.0, (9, 6)).astype(np.float32)
        told = envs.step(actions)[0]
        renewed = period % 9 == 0  # the period after the eighth renews what has ended
        alone = [
            env.reset()[0] if renewed else env.step(action)[0]
            for env, action in zip(singles, actions, strict=True)
        ]
        assert np.array_equal(told, alone), period
    assert data_equivalence(envs.call("get_state"), tuple(env.get_state() for env in singles), exact=True)


@pytest.mark.filterwarnings("ignore:.*:UserWarning")
def test_gymnasium_finds_nothing_wrong():
    check_env(gym.make(ID, sensors=imperfect(noise=0.1, dropout=0.3)).unwrapped, skip_render_check=True)


def test_ways_to_name_sensors():
    assert sensors_of(None) == ()
    assert sensors_of("auv") == AUV
    asked = {"depth_meter": {"noise": 0.1}, "dvl": {"rate": 2.0, "seabed": 30.0}}
    assert sensors_of(asked) == (DVL(rate=2.0, seabed=30.0), DepthMeter(noise=0.1))
    assert StationKeepingEnv(sensors="auv").observation_space.shape == (18 + 4,)
    assert StationKeepingEnv(sensors=asked).observation_space.shape == (18 + 2,)


@pytest.mark.parametrize(
    ("sensors", "complaint"),
    [
        ("submarine", "unknown; give one of"),
        (3, "a list of sensors"),
        ([3], "a list of sensors"),
        ([Gyroscope(), Gyroscope(noise=1.0)], "at most one of each kind"),
        ({"sonar": {}}, "unknown kinds"),
        ({"ahrs": {"noize": 0.1}}, "keys among"),
        ({"ahrs": 0.1}, "keys among"),
        ({"ahrs": {"noise": -0.1}}, "give 0 or more"),
        ({"ahrs": {"noise": math.nan}}, "not finite"),
        ({"ahrs": {"dropout": 1.5}}, "give 0 to 1"),
        ({"ahrs": {"rate": 0.0}}, "above 0"),
    ],
)
def test_what_is_no_sensor_is_refused(sensors, complaint):
    with pytest.raises(InvalidInputError, match=complaint):
        StationKeepingEnv(sensors=sensors)
