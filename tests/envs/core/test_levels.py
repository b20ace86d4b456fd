"""Levels of difficulty: they stand for keywords, and keywords that are given win over them."""

import gymnasium as gym
import pytest
from support.environments import WAYPOINT_TRACKING, StationKeepingEnv

from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.registry import task_called
from dq_marine.errors import InvalidInputError

STATION_KEEPING = "dq_marine/StationKeeping-v0"


def numbers_of(env):
    return (env.task_settings, env.settings.current)


def test_a_level_is_the_keywords_that_it_stands_for():
    levels = task_called(STATION_KEEPING).levels
    at_level = StationKeepingEnv(level="easy")
    assert numbers_of(at_level) == numbers_of(StationKeepingEnv(**levels["easy"]))
    assert numbers_of(at_level) != numbers_of(StationKeepingEnv())


def test_a_keyword_wins_over_the_level():
    env = StationKeepingEnv(level="easy", start_radius=1.75)
    assert env.start_radius == 1.75
    assert env.current_draw == StationKeepingEnv(current=0.0).current_draw


def test_environments_in_lanes_take_a_level_too():
    envs = gym.make_vec(STATION_KEEPING, num_envs=2, level="easy")
    assert envs.single.start_radius == StationKeepingEnv(level="easy").start_radius


@pytest.mark.parametrize("level", ["none", 3, ["easy"], {}, "EASY"])
def test_an_unknown_level_is_refused_with_those_that_there_are(level):
    with pytest.raises(InvalidInputError, match=r"level = .* give one of \['easy', 'medium', 'hard'\]"):
        StationKeepingEnv(level=level)


def test_a_task_without_levels_says_so():
    without = task_called(WAYPOINT_TRACKING)
    bare = TaskDefinition(**{**vars(without), "levels": {}})
    with pytest.raises(InvalidInputError, match="has no levels; leave it out"):
        bare.at_level("easy", {})
