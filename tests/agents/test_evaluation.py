"""Episodes and their scores: seeded, the same for every agent, and computed as documented."""

from __future__ import annotations

import io
import json

import gymnasium as gym
import numpy as np
import pytest
from rich.console import Console

from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment
from dq_marine.agents.episodes import Episode, fly_episode
from dq_marine.agents.evaluation import evaluate, score, score_table
from dq_marine.agents.policies import make_baseline
from dq_marine.errors import InvalidInputError


def episode_of(position: list[float], attitude: list[float] | None = None) -> Episode:
    count = len(position)
    return Episode(
        time=0.1 * np.arange(count, dtype=np.float64),
        position_error=np.array(position),
        attitude_error=np.array(attitude or [0.0] * count),
        actions=np.zeros((count - 1, 6)),
        total_reward=float(count),
        success=position[-1] < 0.1,
        ended_early=False,
    )


def test_evaluation_follows_from_its_seed() -> None:
    def scores(seed: int) -> list[dict[str, object]]:
        env = make_environment(DEFAULT_ENVIRONMENT, max_episode_steps=40)
        agents = {name: make_baseline(name, env, seed=1) for name in ("controller", "random")}
        return [one.as_dict() for one in evaluate(env, agents, episodes=3, seed=seed)]

    assert scores(7) == scores(7)
    assert scores(7) != scores(8)


def test_every_agent_has_the_same_starts() -> None:
    env = make_environment(DEFAULT_ENVIRONMENT, max_episode_steps=5)
    starts = []
    for name in ("zero", "random", "controller"):
        episodes = [fly_episode(env, make_baseline(name, env), seed=seed) for seed in (3, 4)]
        starts.append([(one.position_error[0], one.attitude_error[0]) for one in episodes])
    assert starts[0] == starts[1] == starts[2]
    assert starts[0][0] != starts[0][1]


def test_an_episode_ends_at_the_time_limit_or_at_the_workspace() -> None:
    env = make_environment(DEFAULT_ENVIRONMENT, max_episode_steps=20)
    zero = make_baseline("zero", env)
    limited = fly_episode(env, zero, seed=0)
    assert len(limited.time) == 21
    assert limited.time[-1] == pytest.approx(2.0)
    assert limited.actions.shape == (20, 6)
    assert not limited.ended_early
    away = {"position": (0.0, 5.99, 5.0), "velocity": (0.0,) * 6, "current": (0.0, 0.3, 0.0)}
    assert fly_episode(env, zero, seed=0, options=away).ended_early


def test_scores_are_what_they_say() -> None:
    one = score(
        "some", [episode_of([3.0, 2.0, 1.0, 0.5, 0.2, 0.0]), episode_of([3.0, 2.0, 1.0, 1.0, 1.0, 1.0])]
    )
    assert one.episodes == 2
    assert one.final_position_error.mean == pytest.approx(0.5)
    assert one.steady_position_error.mean == pytest.approx((0.1 + 1.0) / 2.0)
    assert one.steady_position_error.p95 == pytest.approx(0.1 + 0.95 * 0.9)
    assert one.success_rate == 0.5
    assert one.returns.median == 6.0
    assert json.loads(json.dumps(one.as_dict())) == one.as_dict()


def test_attitude_scores_are_in_degrees() -> None:
    one = score("some", [episode_of([0.0, 0.0, 0.0], [1.0, 0.5, np.pi / 180.0])])
    assert one.final_attitude_error_deg.mean == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("position", "attitude", "settled"),
    [
        ([1.0, 0.04, 0.01], [0.0, 0.0, 0.0], 0.1),
        ([1.0, 0.04, 0.01], [1.0, 1.0, 0.0], 0.2),
        ([0.01, 0.06, 0.01], [0.0, 0.0, 0.0], 0.2),
        ([0.01, 0.01, 0.01], [0.0, 0.0, 0.0], 0.0),
        ([0.01, 0.01, 0.06], [0.0, 0.0, 0.0], None),
        ([0.01, 0.01, 0.01], [0.0, 0.0, 0.04], None),
    ],
)
def test_settling_time(position: list[float], attitude: list[float], settled: float | None) -> None:
    assert episode_of(position, attitude).settling_time == settled


def test_table_names_agents_and_units() -> None:
    console = Console(file=io.StringIO(), width=80)
    console.print(score_table([score("some", [episode_of([1.0, 0.5])])]))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    for word in ("some", "median", "95 %", "[m]", "[deg]", "0.500"):
        assert word in text
    assert "…" not in text


def test_an_environment_without_errors_is_refused() -> None:
    env = gym.make("CartPole-v1")
    with pytest.raises(InvalidInputError, match="position_error"):
        fly_episode(env, make_baseline("zero", env), seed=0)
