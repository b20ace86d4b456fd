"""A vector environment that the tests of a file share, reset before each."""

import gymnasium as gym
import pytest
from support.environments import STATION_KEEPING


@pytest.fixture(scope="module")
def module_envs():
    made = gym.make_vec(STATION_KEEPING, num_envs=8)
    yield made
    made.close()


@pytest.fixture
def envs(module_envs):
    module_envs.reset(seed=0)
    return module_envs
