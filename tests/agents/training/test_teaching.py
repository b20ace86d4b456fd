"""What a teacher would do, where it flies itself, where its pupil does, and where both fly in turns."""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from pydantic import ValidationError
from support.trainings import tiny

from dq_marine.agents.controllers.baselines import ZeroAgent, estimate_of, make_baseline
from dq_marine.agents.environments import make_environment
from dq_marine.agents.settings import EnvironmentSettings, ImitationSettings
from dq_marine.agents.training.teaching import taught


def test_in_turns_the_teacher_is_learned_from_only_while_it_flies(tmp_path: Path) -> None:
    settings = tiny(tmp_path, "ppo", 64)
    own = ImitationSettings(episodes=6, noise=0.0, rounds=1, turns=5)
    lessons = taught(settings, own, np.random.default_rng(0), pupil=ZeroAgent(6), first=70)
    told = np.isfinite(lessons.actions).all(axis=1)
    assert (told | np.isnan(lessons.actions).all(axis=1)).all()
    assert 0.2 < told.mean() < 0.8
    assert 12 < np.count_nonzero(np.diff(told)) < 60  # of 180 periods, each a turn with the probability 1/5
    env = make_environment(settings.environment)
    teacher = make_baseline("controller", env, 0)
    row = 0
    for episode, length in enumerate(lessons.lengths):
        observation, _ = env.reset(seed=70 + episode)
        teacher.reset(env)
        for _ in range(length):
            np.testing.assert_array_equal(lessons.observations[row], observation)
            wanted = np.clip(teacher.act(observation), -1.0, 1.0)  # which follows all that happens
            if told[row]:
                np.testing.assert_array_equal(lessons.actions[row], wanted)
            flown = wanted if told[row] else np.zeros(6, np.float32)
            observation, *_ = env.step(flown)
            row += 1
    assert row == len(lessons.actions)


def test_turns_count_in_further_rounds_only(tmp_path: Path) -> None:
    own = ImitationSettings(episodes=1, rounds=1, turns=5)
    lessons = taught(tiny(tmp_path, "ppo", 64), own, np.random.default_rng(0))
    assert np.isfinite(lessons.actions).all()


def test_turns_without_rounds_are_refused() -> None:
    with pytest.raises(
        ValidationError, match=r"imitation\.turns = 5 counts in further rounds.*ask for rounds"
    ):
        ImitationSettings(turns=5)


@pytest.mark.parametrize(("task", "count"), [("Rendezvous", 5), ("FormationKeeping", 8), ("Encounter", 2)])
def test_what_a_controller_has_found_out_comes_with_what_it_does(
    task: str, count: int, tmp_path: Path
) -> None:
    settings = tiny(tmp_path, "recurrent_ppo", 64)
    where = EnvironmentSettings(id=f"dq_marine/{task}-v0", keywords={"max_episode_steps": 40})
    settings = settings.model_copy(update={"environment": where})
    lessons = taught(settings, ImitationSettings(episodes=2), np.random.default_rng(0))
    assert lessons.estimates.shape == (len(lessons.actions), count)
    assert np.isfinite(lessons.estimates).all()
    assert (lessons.estimates.std(axis=0) > 0.0).any()


def test_a_controller_without_a_filter_has_found_out_nothing(tmp_path: Path) -> None:
    lessons = taught(tiny(tmp_path, "ppo", 64), ImitationSettings(episodes=1), np.random.default_rng(0))
    assert lessons.estimates.shape == (len(lessons.actions), 0)


@pytest.mark.parametrize("seed", [0, 1])
def test_the_partner_is_where_the_controller_says_it_is(seed: int) -> None:
    env = gym.make("dq_marine/Rendezvous-v0", level="easy")
    controller = make_baseline("controller", env, 0)
    observation, _ = env.reset(seed=seed)
    controller.reset(env)
    off = []
    over = False
    while not over:
        action = controller.act(observation)
        ahead, starboard, _, _, _ = estimate_of(controller)
        observation, _, terminated, truncated, info = env.step(action)
        off.append(abs(np.hypot(ahead, starboard) - info["distance"]))
        over = terminated or truncated
    env.close()
    assert np.mean(off[100:]) < 1.0


def test_a_forgetful_teacher_does_what_follows_from_what_is_seen_alone(tmp_path: Path) -> None:
    settings = tiny(tmp_path, "ppo", 64)
    own = ImitationSettings(episodes=2, noise=0.0, rounds=1, forgetful=True)
    lessons = taught(settings, own, np.random.default_rng(0), pupil=ZeroAgent(6), first=70)
    env = make_environment(settings.environment)
    teacher = make_baseline("controller", env, 0)
    rows = np.split(np.arange(len(lessons.actions)), np.cumsum(lessons.lengths)[:-1])
    for episode, own_rows in enumerate(rows):
        env.reset(seed=70 + episode)
        for row in np.random.default_rng(1).permutation(own_rows):  # in whichever order it is asked
            teacher.reset(env)
            wanted = np.clip(teacher.act(lessons.observations[row]), -1.0, 1.0)
            np.testing.assert_array_equal(lessons.actions[row], wanted)
    env.close()
    remembering = taught(
        settings,
        own.model_copy(update={"forgetful": False}),
        np.random.default_rng(0),
        pupil=ZeroAgent(6),
        first=70,
    )
    np.testing.assert_array_equal(remembering.observations, lessons.observations)
    assert not np.array_equal(remembering.actions, lessons.actions)
