"""Tasks with goals: observations in parts, and rewards of steps had they ended elsewhere."""

import dataclasses
import importlib.util
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from support.environments import STATION_KEEPING, StationKeepingEnv

from dq_marine.agents.training.vec_env import MarineVecEnv
from dq_marine.envs.core.definition import PARTS
from dq_marine.envs.core.goal_env import GoalMarineEnv
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.registry import task_named, unregister_task
from dq_marine.envs.vector.vector_env import MarineVectorEnv
from dq_marine.errors import InvalidInputError

EXAMPLE = Path(__file__).parents[3] / "examples" / "hindsight_replay.py"


@pytest.fixture(scope="module")
def example():
    """The example's module; its task is registered for these tests only."""
    spec = importlib.util.spec_from_file_location("hindsight_replay", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(__import__("sys").modules, "hindsight_replay", module)
        spec.loader.exec_module(module)
        yield module
    unregister_task(module.ID)


def flight(env, steps=30):
    env.reset(seed=3)
    rng = np.random.default_rng(0)
    for _ in range(steps):
        yield env.step(rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32))


def test_the_observation_is_a_dictionary_that_checkers_accept(example):
    env = gym.make(example.ID)
    assert isinstance(env.observation_space, gym.spaces.Dict)
    assert set(env.observation_space.spaces) == set(PARTS)
    check_env(env.unwrapped, skip_render_check=True)


def test_old_observations_are_refused_by_which_goals_are_judged(example):
    with pytest.raises(InvalidInputError, match=r"observation_delay = 2, but .* has goals.*give 0"):
        gym.make(example.ID, observation_delay=2)


def test_parts_are_the_positions_that_they_are_named_for(example):
    env = gym.make(example.ID)
    for observation, *_ in flight(env):
        here = env.unwrapped.position_ned - np.array(example.CENTRE)
        assert observation["achieved_goal"] == pytest.approx(here, abs=1e-6)
        goal = env.unwrapped.snapshot().goal_position_ned - np.array(example.CENTRE)
        assert observation["desired_goal"] == pytest.approx(goal, abs=1e-6)


def test_the_reward_at_the_own_goal_is_the_steps_own(example):
    env = gym.make(example.ID)
    steps = list(flight(env))
    seen, rewards, infos = ([step[k] for step in steps] for k in (0, 1, 4))
    achieved, desired = (np.array([one[part] for one in seen]) for part in ("achieved_goal", "desired_goal"))
    many = env.unwrapped.compute_reward(achieved, desired, infos)
    assert many == pytest.approx(rewards, abs=1e-12)
    alone = [env.unwrapped.compute_reward(*one) for one in zip(achieved, desired, infos, strict=True)]
    assert alone == many.tolist()
    there = env.unwrapped.compute_reward(achieved, achieved, infos)
    assert there == pytest.approx([float(info["reward/effort"]) for info in infos])


@pytest.mark.sweep  # tests/envs/vector has those without goals
def test_lanes_have_the_bits_of_single_environments(example):
    n = 3
    envs = MarineVectorEnv(example.ID, n, max_episode_steps=10, autoreset_mode=AutoresetMode.SAME_STEP)
    singles = [gym.make(example.ID, max_episode_steps=10) for _ in range(n)]
    envs.reset(seed=0)
    for seed, env in enumerate(singles):
        env.reset(seed=seed)
    rng = np.random.default_rng(0)
    for _ in range(25):
        actions = rng.uniform(-1.0, 1.0, envs.action_space.shape).astype(np.float32)
        together, rewards, _, truncated, infos = envs.step(actions)
        for index, (env, action) in enumerate(zip(singles, actions, strict=True)):
            alone, reward, _, ended, _ = env.step(action)
            assert reward == rewards[index]
            assert ended == truncated[index]
            if ended:
                assert all(np.array_equal(infos["final_obs"][index][part], alone[part]) for part in PARTS)
                alone, _ = env.reset()
            assert all(np.array_equal(together[part][index], alone[part]) for part in PARTS)
    assert all(part in envs.observation_space.spaces for part in together)


@pytest.mark.sweep
def test_the_learning_librarys_environments_know_goals(example):
    envs = MarineVecEnv(gym.make_vec(example.ID, num_envs=2, autoreset_mode="SameStep", max_episode_steps=5))
    begun = envs.reset()
    assert {name: part.shape for name, part in begun.items()} == {
        "observation": (2, 9),
        "achieved_goal": (2, 3),
        "desired_goal": (2, 3),
    }
    for step in range(1, 6):
        seen, rewards, dones, infos = envs.step(np.full((2, 6), 0.5, np.float32))
        assert dones.all() == (step == 5)
        after = [info["terminal_observation"] for info in infos] if dones.all() else None
        achieved, desired = (
            np.array([one[part] for one in after]) if after else seen[part]
            for part in ("achieved_goal", "desired_goal")
        )
        again = envs.env_method("compute_reward", achieved, desired, infos, indices=[0])[0]
        assert again == pytest.approx(rewards, abs=1e-6)


def test_wrong_goals_are_refused(example):
    env = gym.make(example.ID).unwrapped
    _, info = env.reset(seed=0)
    goal = np.zeros(3)
    with pytest.raises(InvalidInputError, match=r"info lacks \['reward/effort'\].*copy_info_dict=True"):
        env.compute_reward(goal, goal, {})
    with pytest.raises(InvalidInputError, match=r"achieved_goal has shape \(2,\)"):
        env.compute_reward(np.zeros(2), goal, info)
    with pytest.raises(InvalidInputError, match="desired_goal"):
        env.compute_reward(goal, np.full(3, np.nan), info)
    with pytest.raises(InvalidInputError, match="StationKeeping-v0 has no goals"):
        GoalMarineEnv(STATION_KEEPING).compute_reward(goal, goal, info)
    assert not hasattr(StationKeepingEnv(), "compute_reward")  # SB3 tells by that which task has goals


def test_a_task_with_half_of_what_goals_need_is_refused(example):
    whole = task_named(example.ID)
    without = dataclasses.replace(whole, goal_reward=None)
    with pytest.raises(InvalidInputError, match="observes goals, but has no goal_reward"):
        MarineEnv(without)
    flat = task_named(STATION_KEEPING)
    with pytest.raises(InvalidInputError, match="has a goal_reward, and observes"):
        MarineEnv(dataclasses.replace(flat, goal_reward=whole.goal_reward))
    parts = [one._replace(part="goal") for one in whole.observations(None, None)]
    with pytest.raises(InvalidInputError, match=r"in parts \['goal'\]; there are"):
        MarineEnv(dataclasses.replace(whole, observations=lambda settings, vehicle: parts))
