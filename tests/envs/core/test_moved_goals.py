"""The goal of an episode under way is put elsewhere."""

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from numpy.testing import assert_allclose

import dq_marine  # noqa: F401 - registers
from dq_marine.envs.core.moved_goal import move_goal
from dq_marine.errors import InvalidInputError


def test_a_goal_that_is_moved_is_that_of_an_episode_begun_with_it() -> None:
    """The same steps follow, and the attitude of the goal stays."""
    turned, there = [math.cos(0.3), 0.0, 0.0, math.sin(0.3)], [1.0, -2.0, 6.0]
    still = {"position": [0.5, 0.0, 5.0], "quaternion": [1.0, 0.0, 0.0, 0.0], "velocity": [0.0] * 6}
    moved, begun = (
        gym.make("dq_marine/StationKeeping-v0", current=0.0, disable_env_checker=True).unwrapped
        for _ in range(2)
    )
    moved.reset(seed=1, options={"goal_quaternion": turned, **still})
    begun.reset(seed=1, options={"goal_quaternion": turned, "goal_position": there, **still})
    move_goal(moved, there)
    push = np.full(6, 0.3, np.float32)
    one, other = moved.step(push), begun.step(push)
    summed = 3  # the integral of the error has that before the move in it
    np.testing.assert_array_equal(one[0][:-summed], other[0][:-summed])
    assert one[1] == other[1]
    assert_allclose(moved.snapshot().goal_quaternion_body_to_ned, turned)
    moved.set_state(moved.get_state())
    assert moved.snapshot().goal_position_ned.tolist() == there


def test_a_goal_up_in_the_air_or_of_no_choice_is_refused() -> None:
    env = gym.make("dq_marine/StationKeeping-v0", current=0.0, disable_env_checker=True).unwrapped
    with pytest.raises(ResetNeeded):
        move_goal(env, [0.0, 0.0, 5.0])
    env.reset(seed=1)
    before = env.episode.episode_parameters.copy()
    for wrong in ([0.0, 0.0, -1.0], [0.0, np.nan, 5.0], [1.0]):
        with pytest.raises(InvalidInputError, match="goal_position"):
            move_goal(env, wrong)
    np.testing.assert_array_equal(env.episode.episode_parameters, before)


def test_a_goal_that_its_episode_draws_stays() -> None:
    env = gym.make("dq_marine/WaypointTracking-v0", disable_env_checker=True).unwrapped
    env.reset(seed=1)
    with pytest.raises(InvalidInputError, match="only those of tasks with the option 'goal_position'"):
        move_goal(env, [0.0, 0.0, 5.0])
