"""Environments in currents that vary: what is drawn, what is told, what stays when something is refused."""

import copy

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from support.environments import StationKeepingEnv

from dq_marine.errors import InvalidInputError
from dq_marine.physics.current.build import CurrentProfile, GaussMarkovCurrent

ID = "dq_marine/StationKeeping-v0"
WANDERING = GaussMarkovCurrent((0.1, -0.2, 0.05), 0.2, 2.0)
PROFILE = CurrentProfile([3.0, 5.0, 8.0], [[0.5, 0.0], [0.2, 0.3], [-0.4, 0.0]])


@pytest.mark.sweep
def test_a_wandering_current_begins_as_it_goes_on():
    """Over many episodes, the current at the start and ten periods later has the same mean and deviation."""
    count = 4000
    envs = gym.make_vec(ID, num_envs=count, current=WANDERING, workspace_radius=50.0)
    _, infos = envs.reset(seed=0)
    first = infos["current_ned"]
    for _ in range(10):
        envs.step(np.zeros(envs.action_space.shape, np.float32))
    later = np.array([envs.at(i).episode.current_ned for i in range(count)])
    for current in (first, later):
        # The mean of 4000 has a standard deviation of 0.0032, their deviation one of 0.0022.
        assert np.abs(current.mean(axis=0) - WANDERING.mean).max() < 0.015
        assert np.abs(current[:, :2].std(axis=0) - 0.2).max() < 0.01
    deviations = [(current - np.array(WANDERING.mean))[:, :2] for current in (first, later)]
    correlation = (deviations[0] * deviations[1]).mean() / 0.04
    assert correlation == pytest.approx(np.exp(-1.0 / 2.0), abs=0.05)
    assert abs((first[:, 0] - 0.1) @ (first[:, 1] + 0.2)) / count / 0.04 < 0.05


def test_the_process_does_not_depend_on_the_action_nor_on_what_is_refused():
    env, other = (StationKeepingEnv(current=WANDERING) for _ in range(2))
    for each in (env, other):
        each.reset(seed=5)
    for _ in range(5):
        env.step(np.ones(6, np.float32))
        with pytest.raises(InvalidInputError, match="not finite"):
            other.step(np.full(6, np.nan, np.float32))
        other.step(np.zeros(6, np.float32))
        assert np.array_equal(env.episode.current_ned, other.episode.current_ned)
    assert not np.array_equal(env.position_ned, other.position_ned)


def test_states_are_restored_with_the_current_on_its_way():
    env, other = (StationKeepingEnv(current=WANDERING) for _ in range(2))
    env.reset(seed=1)
    for _ in range(3):
        env.step(np.ones(6, np.float32))
    other.set_state(env.get_state())
    assert np.array_equal(other.velocity_body, env.velocity_body)
    for _ in range(3):
        results = [each.step(np.ones(6, np.float32)) for each in (env, other)]
        assert data_equivalence(*results, exact=True)


def test_an_option_sets_where_a_wandering_current_begins():
    env = StationKeepingEnv(current=WANDERING)
    _, info = env.reset(seed=0, options={"current": (1.0, 0.5, 0.2)})
    assert np.array_equal(info["current_ned"], (1.0, 0.5, 0.2))


def test_a_profile_tells_the_current_at_the_vehicle():
    env = StationKeepingEnv(current=PROFILE)
    _, info = env.reset(seed=0, options={"position": (0.0, 1.0, 4.0)})
    assert np.allclose(info["current_ned"], PROFILE.at(4.0), atol=1e-15)
    for _ in range(20):
        env.step(np.array([0, 0, 0.5, 0, 0, 0], np.float32))
        met = env.snapshot().current_ned
        assert np.allclose(met, PROFILE.at(env.position_ned[2]), atol=1e-14)
    with pytest.raises(InvalidInputError, match="has a current profile"):
        env.reset(options={"current": (0.1, 0.0, 0.0)})


def test_steady_currents_draw_nothing_in_a_period():
    env = StationKeepingEnv(current=0.3)
    env.reset(seed=0)
    before = env.np_random.bit_generator.state
    env.step(np.zeros(6, np.float32))
    assert env.np_random.bit_generator.state == before


# Currents that are turned in mid-episode


@pytest.fixture
def in_a_current():
    env = gym.make("dq_marine/StationKeeping-v0", current=0.3, disable_env_checker=True).unwrapped
    env.reset(seed=2)
    for _ in range(10):
        env.step(np.full(6, 0.4, np.float32))
    return env


def test_a_current_that_is_turned_leaves_the_velocity_over_ground(in_a_current):
    env = in_a_current
    over_ground, observation = env.velocity_body, env.observation
    env.set_current((0.5, 0.2, -0.1))
    assert env.velocity_body == pytest.approx(over_ground, abs=1e-14)
    assert np.array_equal(env.observation, observation)
    assert env.episode.current_ned.tolist() == [0.5, 0.2, -0.1]
    assert env.velocity_through_water != pytest.approx(over_ground[:3], abs=0.1)
    _, _, _, _, info = env.step(np.zeros(6, np.float32))
    assert info["current_ned"].tolist() == [0.5, 0.2, -0.1]


def test_a_current_that_is_turned_goes_on_as_one_that_was_always_there(in_a_current):
    """Saved and restored, and begun in it with the same motion: the same flight."""
    env = in_a_current
    env.set_current((0.5, 0.2, -0.1))
    other = gym.make("dq_marine/StationKeeping-v0", current=0.3, disable_env_checker=True).unwrapped
    other.reset(
        seed=2,
        options={
            "current": [0.5, 0.2, -0.1],
            "position": env.position_ned,
            "quaternion": env.quaternion_body_to_ned,
            "velocity": env.velocity_body,
        },
    )
    twin = copy.deepcopy(env)
    for _ in range(50):
        for one in (env, other, twin):
            one.step(np.full(6, -0.2, np.float32))
    assert np.array_equal(twin.position_ned, env.position_ned)
    assert other.position_ned == pytest.approx(env.position_ned, abs=1e-9)
    assert other.velocity_body == pytest.approx(env.velocity_body, abs=1e-9)


@pytest.mark.parametrize(
    ("current", "complaint"),
    [((np.nan, 0, 0), "current_ned"), ((0, 0), "current_ned"), ((1e9, 0, 0), "current_ned")],
)
def test_a_wrong_current_changes_nothing(in_a_current, current, complaint):
    before = in_a_current.get_state()
    with pytest.raises(InvalidInputError, match=complaint):
        in_a_current.set_current(current)
    assert data_equivalence(before, in_a_current.get_state(), exact=True)


@pytest.mark.parametrize("current", [0.0, {"standard_deviation": 0.1, "correlation_time": 5.0}])
def test_water_that_is_still_or_moves_by_itself_cannot_be_turned(current):
    env = gym.make("dq_marine/StationKeeping-v0", current=current, disable_env_checker=True).unwrapped
    env.reset(seed=0)
    with pytest.raises(InvalidInputError, match="make it with current="):
        env.set_current((0.1, 0.0, 0.0))
