"""The agents' protocol, kept by every agent, and what is particular to each."""

from __future__ import annotations

import numpy as np
import pytest

from dq_marine.agents.choice import common_environment, make_agents
from dq_marine.agents.controllers.baselines import BASELINES, RandomAgent, make_baseline
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, with_keywords
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.errors import InvalidInputError


@pytest.mark.parametrize("name", BASELINES)
def test_every_baseline_keeps_the_protocol(name: str) -> None:
    env = make_environment(DEFAULT_ENVIRONMENT)
    agent = make_baseline(name, env)
    for seed in range(2):
        observation, _ = env.reset(seed=seed)
        agent.reset(env)
        for _ in range(5):
            action = agent.act(observation)
            assert env.action_space.contains(action)
            observation, *_ = env.step(action)


def test_random_agent_follows_from_its_seed() -> None:
    observation = np.zeros(18, dtype=np.float32)
    draws = [RandomAgent(6, seed).act(observation) for seed in (4, 4, 5)]
    np.testing.assert_array_equal(draws[0], draws[1])
    assert (draws[0] != draws[2]).any()


def test_random_agent_draws_anew_in_every_episode() -> None:
    env = make_environment(DEFAULT_ENVIRONMENT)
    agent, observation = RandomAgent(6, 0), np.zeros(18, dtype=np.float32)
    first = agent.act(observation)
    agent.reset(env)
    assert (agent.act(observation) != first).any()


def test_unknown_names_are_refused() -> None:
    env = make_environment(DEFAULT_ENVIRONMENT)
    with pytest.raises(
        InvalidInputError,
        match=r"'pid' is unknown; give one of \['controller', 'zero', 'random', 'lqr', 'mpc'\]",
    ):
        make_agents(["pid"], [], env, seed=0)


def test_environment_of_no_run_is_station_keeping() -> None:
    assert common_environment([]) == DEFAULT_ENVIRONMENT


def test_wrong_environments_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="dq_marine/Nothing-v0"):
        make_environment(EnvironmentSettings(id="dq_marine/Nothing-v0"))
    with pytest.raises(InvalidInputError, match="'colour'"):
        make_environment(with_keywords(DEFAULT_ENVIRONMENT, colour="red"))
    with pytest.raises(InvalidInputError, match="current"):
        make_environment(with_keywords(DEFAULT_ENVIRONMENT, current=-1.0))
