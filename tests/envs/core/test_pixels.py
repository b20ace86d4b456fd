"""Pictures as observations: Gymnasium's checker, what they show, and who refuses them."""

import copy
import pickle
import re
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import dq_marine  # noqa: F401 - registers
from dq_marine.envs.core.pixels import PixelObservation
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"
AWAY = {"position": (1.5, 0.5, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 6}
SMALL = {"pixels": [96, 64]}


@pytest.mark.browser
def test_gymnasiums_checker_passes_with_pictures():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*different from the unwrapped version")  # it is a wrapper
        env = gym.make(ID, observation=SMALL)
        check_env(env, skip_render_check=True)
        env.close()


@pytest.mark.browser
def test_pictures_follow_the_state_and_nothing_else():
    env = gym.make(ID, observation=SMALL, current=None)
    first, info = env.reset(seed=0, options=AWAY)
    assert env.observation_space == gym.spaces.Box(0, 255, (64, 96, 3), np.uint8)
    assert env.observation_space.contains(first)
    assert "is_success" in info
    state = env.unwrapped.get_state()
    action = np.array([-1.0, 0.0, 0.0, 0.0, 0.0, 0.3], dtype=np.float32)
    for _ in range(20):
        env.unwrapped.step(action)  # without a picture
    later, *_ = env.step(action)
    assert (np.abs(later.astype(int) - first.astype(int)).max(axis=2) > 30).mean() > 0.002
    env.unwrapped.set_state(state)
    assert np.array_equal(env.get_wrapper_attr("observation")(None), first)  # no trail led here
    env.close()
    env.close()


@pytest.mark.browser
def test_one_state_has_one_picture():
    # With the goal's ghost, arrows of the current and specks.
    env = gym.make(ID, observation=SMALL)
    pictures = {seed: env.reset(seed=seed)[0] for seed in (123, 124, 125)}
    for _ in range(30):
        for seed, first in pictures.items():
            assert np.array_equal(env.reset(seed=seed)[0], first)
    env.close()


def test_environments_of_pictures_travel_and_are_made_again_from_their_spec():
    env = gym.make(ID, observation="pixels")
    for other in (pickle.loads(pickle.dumps(env)), copy.deepcopy(env), gym.make(env.spec)):
        assert other.observation_space == gym.spaces.Box(0, 255, (240, 320, 3), np.uint8)
        assert isinstance(other.env.env.env, PixelObservation)


def test_numbers_are_the_default_and_may_be_said():
    for env in (gym.make(ID), gym.make(ID, observation="numbers")):
        assert env.observation_space.dtype == np.float32


@pytest.mark.parametrize("observation", ["pixels", SMALL])
def test_vector_environments_refuse_pictures(observation):
    with pytest.raises(InvalidInputError, match=r"a vector environment observes numbers.*single one"):
        gym.make_vec(ID, num_envs=2, observation=observation)


@pytest.mark.parametrize(
    ("observation", "message"),
    [
        ("depth", "'numbers', 'pixels'"),
        (None, "observation = None"),
        (7, "observation = 7"),
        ({}, "observation = {}"),
        ({"pixels": 64}, "[width, height]"),
        ({"pixels": [64]}, "[width, height]"),
        ({"pixels": [64.5, 64]}, "['pixels'][0] = 64.5 is not an integer"),
        ({"pixels": [64, 8]}, "['pixels'][1] = 8 is below 32"),
        ({"pixels": [4096, 64]}, "give one from 32 to 2048"),
        ({"pixels": [64, 64], "depth": [64, 64]}, "give 'numbers'"),
    ],
)
def test_other_observations_are_refused(observation, message):
    for make in (
        lambda: gym.make(ID, observation=observation),
        lambda: gym.make_vec(ID, observation=observation),
    ):
        with pytest.raises(InvalidInputError, match=re.escape(message)):
            make()
