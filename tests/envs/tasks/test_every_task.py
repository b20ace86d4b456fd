"""What holds for every task that ships with every vehicle that it suits: the registry tells, so that none escapes."""

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from support.environments import STATION_KEEPING
from support.separate import Separate, assert_flights_agree
from support.suited import SUITED
from support.sweeps import sweep

import dq_marine
from dq_marine.envs.core.registry import shipped_tasks, short_name

TASKS = {short_name(one): one for one in shipped_tasks()}

SOON_COMPILED = [(STATION_KEEPING, "bluerov2_heavy")]
"""Its lanes are compiled for `tests/envs/vector` already."""

every_flight = pytest.mark.parametrize(("task", "vehicle"), sweep(SUITED, plain=SOON_COMPILED))
every_task = pytest.mark.parametrize("task", sweep(TASKS, plain=["StationKeeping"]))


@every_flight
def test_lanes_are_single_environments_bit_for_bit(task, vehicle):
    limits = {"vehicle": vehicle, "max_episode_steps": 90}
    envs = gym.make_vec(task, num_envs=3, **limits)
    assert_flights_agree(envs, Separate(3, task, **limits), 300, seed=1)


@every_flight
def test_ten_thousand_random_steps_stay_finite_and_within_the_observation_space(task, vehicle):
    envs = gym.make_vec(task, num_envs=40, vehicle=vehicle)
    envs.reset(seed=5)
    envs.action_space.seed(5)
    for _ in range(250):
        observations, rewards, *_ = envs.step(envs.action_space.sample())
        assert np.isfinite(rewards).all()
        assert observations in envs.observation_space


@pytest.mark.browser
@every_task
def test_a_picture_is_drawn(task):
    env = gym.make(TASKS[task].id, render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    env.close()
    assert picture.dtype == np.uint8
    assert picture.std() > 5.0  # there is something to see


@pytest.mark.parametrize("task", TASKS)
def test_a_task_is_one_file_of_at_most_250_lines_that_nobody_imports(task):
    module = TASKS[task].parameters.__module__
    folder = Path(dq_marine.__file__).parent
    file = folder / Path(*module.split(".")[1:]).with_suffix(".py")
    assert len(file.read_text(encoding="utf-8").splitlines()) <= 250
    name = module.rpartition(".")[2]
    importing = [
        other
        for other in folder.rglob("*.py")
        if f"tasks.{name}" in other.read_text(encoding="utf-8")
        or f"import {name}" in other.read_text(encoding="utf-8")
    ]
    assert importing == []


LEVELS = [(name, level) for name, task in TASKS.items() for level in task.levels]


@pytest.mark.parametrize(("task", "level"), sweep(LEVELS, plain=[("StationKeeping", "easy")]))
def test_every_level_can_be_flown(task, level):
    env = gym.make(TASKS[task].id, level=level)
    env.reset(seed=0)
    _, reward, *_ = env.step(env.action_space.sample())
    assert np.isfinite(reward)
