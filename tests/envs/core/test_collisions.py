"""What a task says of collisions, asked in plain Python of an episode that has begun."""

from __future__ import annotations

import gymnasium as gym
import pytest
from gymnasium.error import ResetNeeded

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.registry import registered_tasks, task_called
from dq_marine.envs.core.shared_memory import parameters_of, task_memory
from dq_marine.task.docks import Contact


def begun(task: str, **reset) -> MarineEnv:
    env = gym.make(task, disable_env_checker=True, current=0.0).unwrapped
    env.reset(seed=1, **reset)
    return env


@pytest.mark.parametrize("task", registered_tasks(), ids=lambda task: task.id)
def test_no_vehicle_begins_in_a_collision(task):
    assert begun(task.id).collided is (None if task.collided is None else False)


def test_a_vehicle_in_a_pillar_has_hit_it():
    env = begun("dq_marine/ObstacleAvoidance-v0")
    pillar = env.snapshot().things[0].position_ned
    place = (float(pillar[0]), float(pillar[1]), float(env.position_ned[2]))
    assert begun("dq_marine/ObstacleAvoidance-v0", options={"position": place}).collided is True


@pytest.mark.parametrize("struck", [0.0, 1.0])
def test_a_dock_is_hit_where_it_is_struck_and_not_where_a_bow_is_docked(struck):
    memory = task_memory(begun("dq_marine/Docking-v0"))
    met = memory._replace(contact=Contact(0.0, 1.0 - struck, struck, 0.2))
    assert task_called("Docking").collided(None, met) is (struck > 0.5)


def test_vessels_collide_within_the_safe_distance():
    """Of the same vessels, with the distance of the task and with one that reaches beyond them."""
    env = begun("dq_marine/Encounter-v0")
    own, memory = parameters_of(env).task, task_memory(env)
    near = own._replace(safe=1e9)
    assert task_called("Encounter").collided(own, memory) is False
    assert task_called("Encounter").collided(near, memory) is True


def test_before_the_first_reset_nothing_can_be_said():
    env = gym.make("dq_marine/Docking-v0", disable_env_checker=True).unwrapped
    with pytest.raises(ResetNeeded):
        _ = env.collided
