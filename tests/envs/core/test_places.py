"""No goal is up in the air or beyond the Earth, wherever it is named; no start is beyond it either."""

import gymnasium as gym
import numpy as np
import pytest
from support.environments import StationKeepingEnv
from support.equivalence import same

import dq_marine
from dq_marine.envs.core.places import FARTHEST, starting_depth
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"
FAR = [
    ((0.0, 0.0, -5.0), r"up in the air.*give a depth of 0 m or more"),
    ((1e182, 0.0, 5.0), r"beyond 1e\+06 m; give a place nearer"),
    ((0.0, 0.0, 1e182), "beyond"),
]


@pytest.mark.parametrize(("place", "message"), FAR)
def test_a_goal_is_in_the_water_and_on_earth(place, message):
    with pytest.raises(InvalidInputError, match=rf"goal_position.*{message}"):
        StationKeepingEnv(goal_position=place)
    env = StationKeepingEnv()
    env.reset(seed=0)
    before = env.get_state()
    for change in (
        lambda: env.reset(seed=5, options={"goal_position": place}),
        lambda: setattr(env, "goal_position", place),
    ):
        with pytest.raises(InvalidInputError, match=rf"goal_position.*{message}"):
            change()
        assert same(env.get_state(), before)


@pytest.mark.parametrize(("place", "message"), FAR)
def test_the_goal_of_each_of_many_is_checked(place, message):
    """Also where another one's numbers are larger."""
    envs = gym.make_vec(ID, num_envs=3)
    envs.reset(seed=0)
    before = envs.call("get_state")
    goals = np.array([(0.0, 0.0, 90.0), place, (0.0, 0.0, 5.0)])
    with pytest.raises(InvalidInputError, match=message):
        envs.reset(options={"goal_position": goals})
    assert same(envs.call("get_state"), before)


def test_a_start_is_on_earth():
    env = StationKeepingEnv()
    with pytest.raises(InvalidInputError, match=r"options\['position'\].*beyond"):
        env.reset(options={"position": (0.0, -1e182, 5.0)})
    env.reset(options={"position": (FARTHEST, 0.0, 5.0), "goal_position": (FARTHEST, 0.0, 5.0)})


def test_a_vessel_that_floats_may_be_lifted_a_little():
    vessel = dq_marine.load_vehicle("otter")
    StationKeepingEnv(vehicle=vessel, goal_position=(0.0, 0.0, -0.1))
    with pytest.raises(InvalidInputError, match=rf"up in the air.*for {vessel.name}"):
        StationKeepingEnv(vehicle=vessel, goal_position=(0.0, 0.0, -5.0))


@pytest.mark.parametrize(
    ("reward", "message"),
    [
        ({"position": 1e308}, r"reward\.position = 1e\+308; give at most 1e\+06"),
        ({"effort": 1e7}, "give at most"),
        ({"position_width": 1e-308}, r"reward\.position_width = 1e-308; give at least 1e-06"),
        ({"attitude_width": 1e308}, "give at most"),
    ],
)
def test_a_reward_stays_a_number_that_can_be_learned_from(reward, message):
    with pytest.raises(InvalidInputError, match=message):
        StationKeepingEnv(reward=reward)


def test_an_added_reward_stays_one_too():
    term = dq_marine.RewardTerm("speed", lambda own, now: 1.0, -1e308)
    with pytest.raises(InvalidInputError, match=r"weight of the reward 'speed' = -1e\+308; give at least"):
        StationKeepingEnv(extra_rewards=[term])


def test_the_current_of_an_episode_is_water():
    env = StationKeepingEnv(current=0.3)
    with pytest.raises(InvalidInputError, match=r"options\['current'\] has 50 m/s; give at most 20 m/s"):
        env.reset(options={"current": (50.0, 0.0, 0.0)})


@pytest.mark.parametrize("name", dq_marine.vehicle_names())
def test_vehicles_start_with_room_above_them_or_at_rest(name):
    """Wherever they start, what holds them up is their weight, or nothing of them is near the surface."""
    vehicle = dq_marine.load_vehicle(name)
    depth = starting_depth(vehicle, 7.0)
    if vehicle.hydrostatics is not None:
        assert depth == vehicle.equilibrium_depth
    else:
        assert depth >= 7.0
        assert depth - vehicle.dimensions.height >= 9.0 * vehicle.dimensions.length
