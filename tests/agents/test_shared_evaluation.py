"""Episodes that a team flies are those that one process flies, of every agent."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from support.command_line import assert_refused, run

from dq_marine.agents.choice import make_agents
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment, with_keywords
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.shared_evaluation import EPISODES_OF_A_SHARE, evaluate_by_team

AGENTS = ["controller", "zero", "random"]
EPISODES = 2 * EPISODES_OF_A_SHARE + 1


def in_threads(tasks: int) -> Any:
    assert tasks == 7  # three shares of the agents that an episode's seed is enough for, and one of the other
    return ThreadPoolExecutor(2)


def test_scores_are_those_of_one_process() -> None:
    environment = with_keywords(DEFAULT_ENVIRONMENT, max_episode_steps=12)
    env = make_environment(environment)
    agents = make_agents(AGENTS, [], env, seed=4)
    here = evaluate(env, agents, episodes=EPISODES, seed=4)
    told: list[tuple[str, int]] = []
    shared = evaluate_by_team(
        environment,
        AGENTS,
        [],
        episodes=EPISODES,
        seed=4,
        team=in_threads,
        after_episode=lambda agent, episode: told.append((agent, episode.seed)),
    )
    assert shared == here
    assert sorted(told) == sorted((agent, seed) for agent in AGENTS for seed in range(4, 4 + EPISODES))


@pytest.mark.slow
@pytest.mark.sweep
def test_the_command_writes_the_same_scores(tmp_path: Path) -> None:
    command = ["evaluate", "--policy", "StationKeeping", "--agent", "random", "--episodes", "12"]
    written = []
    for options in ([], ["--processes", "2"]):
        scores = tmp_path / f"{len(options)}.json"
        done = run(*command, "--set", "max_episode_steps=20", "--json", scores, *options)
        assert done.exit_code == 0, done.output
        written.append(json.loads(scores.read_text()))
    assert written[0] == written[1]


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        (["--address", "h:1"], "--address h:1 needs --distributed"),
        (["--scenario", "StationKeeping/calm", "--processes", "2"], "leaderboard --scenarios"),
    ],
)
def test_what_is_not_shared_out_is_refused(options: list[str], pattern: str) -> None:
    assert_refused(run("evaluate", *options), pattern)
