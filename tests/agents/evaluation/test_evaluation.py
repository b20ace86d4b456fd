"""Episodes and their scores: seeded, the same for every agent, and computed as documented."""

from __future__ import annotations

import io
import json
import re
from dataclasses import replace
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import pytest
from rich.console import Console
from rich.table import Table

from dq_marine.agents.controllers.baselines import make_baseline
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, make_environment
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.evaluation import evaluate, score, score_table
from dq_marine.agents.evaluation.flight import episode_table
from dq_marine.agents.evaluation.metrics import Metric, metrics_of, reward_term_names
from dq_marine.envs.core.registry import task_named
from dq_marine.errors import InvalidInputError

METRICS = (Metric("depth_error", "m", tolerance=0.05), Metric("tilt", "rad", tolerance=np.radians(2.0)))
"""Of a task that nothing here knows."""


def episode_of(depth: list[float], tilt: list[float] | None = None, **others: Any) -> Episode:
    count = len(depth)
    values: dict[str, Any] = {
        "time": 0.1 * np.arange(count, dtype=np.float64),
        "metrics": METRICS,
        "measured": {"depth_error": np.array(depth), "tilt": np.array(tilt or [0.0] * count)},
        "actions": np.zeros((count - 1, 1)),
        "action_names": ("heave",),
        "rewards": np.ones(count - 1),
        "reward_terms": {},
        "success": depth[-1] < 0.1,
        "ended_early": False,
    }
    return Episode(**values | others)


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
        starts.append([[float(values[0]) for values in one.measured.values()] for one in episodes])
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
    depth = one.metrics["depth_error"]
    assert depth.final.mean == pytest.approx(0.5)
    assert depth.steady.mean == pytest.approx((0.1 + 1.0) / 2.0)
    assert depth.steady.p95 == pytest.approx(0.1 + 0.95 * 0.9)
    assert one.success_rate == 0.5
    assert one.returns.median == 5.0
    assert json.loads(json.dumps(one.as_dict())) == one.as_dict()
    assert one.as_dict()["metrics"]["depth_error_m"]["final"]["mean"] == depth.final.mean


def test_angles_are_scored_in_degrees() -> None:
    one = score("some", [episode_of([0.0, 0.0, 0.0], [1.0, 0.5, np.pi / 180.0])])
    assert one.metrics["tilt"].final.mean == pytest.approx(1.0)
    assert "tilt_deg" in one.as_dict()["metrics"]


@pytest.mark.parametrize(
    ("depth", "tilt", "settled"),
    [
        ([1.0, 0.04, 0.01], [0.0, 0.0, 0.0], 0.1),
        ([1.0, 0.04, 0.01], [1.0, 1.0, 0.0], 0.2),
        ([0.01, 0.06, 0.01], [0.0, 0.0, 0.0], 0.2),
        ([0.01, 0.01, 0.01], [0.0, 0.0, 0.0], 0.0),
        ([0.01, 0.01, 0.06], [0.0, 0.0, 0.0], None),
        ([0.01, 0.01, 0.01], [0.0, 0.0, 0.04], None),
    ],
)
def test_settling_time(depth: list[float], tilt: list[float], settled: float | None) -> None:
    assert episode_of(depth, tilt).settling_time == settled


def printed(table: Table, width: int = 80) -> str:
    console = Console(file=io.StringIO(), width=width)
    console.print(table)
    return console.file.getvalue()  # type: ignore[attr-defined,no-any-return]


def test_table_names_agents_metrics_and_units() -> None:
    text = printed(score_table([score("some", [episode_of([1.0, 0.5])])], ["trained elsewhere"]))
    for word in ("some", "median", "95 %", "depth", "tilt", "[m]", "[deg]", "0.500", "trained elsewhere"):
        assert word in text
    assert "…" not in text


def test_a_long_name_gives_way_to_numbers() -> None:
    text = printed(score_table([score("of_the_second_try" * 5, [episode_of([1.0, 0.5])])]))
    assert "…" not in text
    assert "0.500" in text
    pieces = [line.split()[0] for line in text.splitlines() if line.strip()]
    assert "".join(pieces).count("of_the_second_try") == 5  # whole, over several lines


def test_a_flights_table_names_metrics_reward_terms_and_the_seed() -> None:
    near, effort, idle = ([0.5, 0.25], [-0.5, -0.25], [-0.0, -0.01])
    terms = {"reward/near": np.array(near), "reward/effort": np.array(effort), "reward/idle": np.array(idle)}
    text = printed(episode_table(episode_of([1.0, 0.04, 0.01], reward_terms=terms, seed=7)))
    for pattern in (
        r"depth error, start\s+│\s+1\.000 m",
        r"settled within 0\.05 m and 2 deg\s+│ after 0\.1 s",
        r"return\s+│\s+2\.0",
        r"of which near\s+│\s+0\.8",
        r"of which effort\s+│\s+-0\.8",
        r"of which idle\s+│\s+0\.0",
        r"seed\s+│\s+7",
    ):
        assert re.search(pattern, text), pattern


def test_without_tolerances_nothing_is_said_of_settling() -> None:
    one = episode_of([1.0, 0.5], metrics=(Metric("depth_error", "m"),))
    assert "settled" not in printed(episode_table(one))
    assert "depth error, end" in printed(episode_table(one))


def test_metrics_are_those_of_the_task() -> None:
    class Measured(NamedTuple):
        depth_error: float
        tilt: float
        laps: float

    definition = task_named(DEFAULT_ENVIRONMENT.id)
    other = replace(
        definition,
        id="tests/Other-v0",
        task=replace(definition.task, metrics=Measured),
        units={"depth_error": "m", "tilt": "rad"},
        tolerances={"depth_error": 0.05},
    )
    assert metrics_of(other) == (Metric("depth_error", "m", 0.05), Metric("tilt", "rad"), Metric("laps"))
    assert [metric.shown_name for metric in metrics_of(other)] == ["depth_error_m", "tilt_deg", "laps"]
    assert metrics_of(other)[1].text(metrics_of(other)[1].shown(np.pi)) == "180.00 deg"


def test_reward_terms_are_found_in_infos() -> None:
    assert reward_term_names({"tilt": 1.0, "reward/near": 0.25, "_reward/near": True}) == ("reward/near",)


def test_other_environments_are_refused() -> None:
    env = gym.make("CartPole-v1")
    with pytest.raises(InvalidInputError, match="not an environment of dq_marine"):
        fly_episode(env, make_baseline("zero", env), seed=0)


def test_no_scores_are_no_table() -> None:
    with pytest.raises(InvalidInputError, match="no scores to show; evaluate an agent"):
        score_table([])
