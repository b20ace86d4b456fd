"""Gymnasium's wrappers around the vector environment act on what Stable-Baselines3 sees, or are refused."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import VectorEnv, VectorObservationWrapper, VectorWrapper
from gymnasium.wrappers import vector as wrappers
from stable_baselines3.common.monitor import Monitor

from dq_marine.agents.training.vec_env import MarineVecEnv
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"
BUSY: dict[str, Any] = {"max_episode_steps": 7, "workspace_radius": 2.05, "current": 1.0}
"""Episodes so short and starts so near the edge that episodes end all the time, in both ways."""

COUNT = 3

same = partial(data_equivalence, exact=True)

Wrap = Callable[[VectorEnv[Any, Any, Any]], VectorEnv[Any, Any, Any]]


def plain(**keywords: Any) -> VectorEnv[Any, Any, Any]:
    return gym.make_vec(ID, num_envs=COUNT, autoreset_mode="SameStep", **{**BUSY, **keywords})


def made(*wraps: Wrap, **keywords: Any) -> MarineVecEnv:
    """Return wrapped environments, seeded and reset."""
    envs = plain(**keywords)
    for wrap in wraps:
        envs = wrap(envs)
    learned_in = MarineVecEnv(envs)
    learned_in.seed(4)
    learned_in.reset()
    return learned_in


def actions_for(periods: int, scale: float = 1.0) -> np.ndarray:
    return np.random.default_rng(0).uniform(-scale, scale, (periods, COUNT, 6)).astype(np.float32)


def doubled(rewards: np.ndarray) -> np.ndarray:
    return 2.0 * rewards + 1.0


class Halved(VectorWrapper):
    """Changes observations, and those that episodes end with: what a wrapper of one's own has to do."""

    def reset(self, **keywords: Any) -> Any:
        observations, infos = self.env.reset(**keywords)
        return 0.5 * observations, infos

    def step(self, actions: Any) -> Any:
        observations, *others, infos = self.env.step(actions)
        for index in np.flatnonzero(infos.get("_final_obs", np.zeros(self.num_envs))):
            infos["final_obs"][index] = 0.5 * infos["final_obs"][index]
        return 0.5 * observations, *others, infos


class First(VectorWrapper):
    """Shows the first three numbers of an observation, but forgets those that episodes end with."""

    def __init__(self, env: Any) -> None:
        super().__init__(env)
        self.single_observation_space = gym.spaces.Box(-9.0, 9.0, (3,), np.float32)

    def reset(self, **keywords: Any) -> Any:
        observations, infos = self.env.reset(**keywords)
        return observations[:, :3], infos

    def step(self, actions: Any) -> Any:
        observations, *others = self.env.step(actions)
        return observations[:, :3], *others


class Ending(VectorWrapper):
    """Says after the first step that an episode is over."""

    def step(self, actions: Any) -> Any:
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        terminated[1] = True
        return observations, rewards, terminated, truncated, infos


class Prolonging(VectorWrapper):
    """Never lets an episode be over."""

    def step(self, actions: Any) -> Any:
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        return observations, rewards, terminated & False, truncated & False, infos


class Counting(VectorWrapper):
    """Adds to the infos of every step."""

    steps = 0

    def step(self, actions: Any) -> Any:
        *others, infos = self.env.step(actions)
        self.steps += 1
        infos["steps"] = np.full(self.num_envs, self.steps)
        infos["_steps"] = np.array([True, False, True])
        return *others, infos


class Shifted(VectorObservationWrapper):
    """What Gymnasium before 1.2 let around such environments."""

    def __init__(self, env: Any) -> None:
        VectorWrapper.__init__(self, env)

    def observations(self, observations: Any) -> Any:
        return observations + 1.0


class Foreign(VectorEnv):
    """Wraps without being a wrapper by Gymnasium's measure."""

    def __init__(self, env: Any) -> None:
        self.env = env

    @property
    def unwrapped(self) -> Any:
        return self.env.unwrapped


class ArrayConversion(VectorWrapper):
    """Stands for Gymnasium's base class of that name, whose module needs a library that is not among the extras."""


class ToTensors(ArrayConversion):
    """Stands for `NumpyToTorch`."""


def test_rewards_are_those_of_the_wrappers() -> None:
    bare, wrapped = made(), made(partial(wrappers.TransformReward, func=doubled))
    for actions in actions_for(20):
        expected, result = bare.step(actions), wrapped.step(actions)
        np.testing.assert_allclose(result[1], doubled(expected[1]), rtol=1e-6)
        assert same(result[0], expected[0])
        assert same(result[3], expected[3])


def test_a_clipped_reward_is_clipped() -> None:
    envs = made(partial(wrappers.ClipReward, min_reward=0.05, max_reward=0.1))
    rewards = np.array([envs.step(actions)[1] for actions in actions_for(20)])
    assert rewards.dtype == np.float32
    assert rewards.min() == np.float32(0.05)
    assert rewards.max() == np.float32(0.1)


def test_actions_go_through_the_wrappers() -> None:
    """From [0, 2] of the wrapper to [-1, 1] of the environments."""
    bare, wrapped = (
        made(),
        made(partial(wrappers.RescaleAction, min_action=np.float32(0.0), max_action=np.float32(2.0))),
    )
    assert wrapped.action_space == gym.spaces.Box(0.0, 2.0, (6,), np.float32)
    for actions in actions_for(20):
        expected, result = bare.step(actions), wrapped.step(actions + 1.0)
        np.testing.assert_allclose(result[0], expected[0], rtol=1e-4, atol=1e-5)
        assert same(result[2], expected[2])


def test_statistics_of_episodes_come_with_their_end() -> None:
    envs = made(wrappers.RecordEpisodeStatistics)
    returns, lengths, seen = np.zeros(COUNT), np.zeros(COUNT, int), 0
    for actions in actions_for(40):
        _, rewards, dones, infos = envs.step(actions)
        returns += rewards
        lengths += 1
        for index in range(COUNT):
            assert ("episode" in infos[index]) == dones[index]
            assert "episode" not in envs.reset_infos[index]
            if dones[index]:
                assert infos[index]["episode"]["l"] == lengths[index]
                assert infos[index]["episode"]["r"] == pytest.approx(returns[index], rel=1e-5)
                assert "terminal_observation" in infos[index]
                returns[index], lengths[index], seen = 0.0, 0, seen + 1
    assert seen > 10


def test_infos_of_environments_that_go_on_have_what_wrappers_add() -> None:
    bare, wrapped = made(), made(Counting)
    for number, actions in enumerate(actions_for(20)):
        expected, (*_, infos) = bare.step(actions), wrapped.step(actions)
        assert [info.pop("steps", None) for info in infos] == [number + 1, None, number + 1]
        assert same(infos, expected[3])
        assert same(wrapped.reset_infos, bare.reset_infos)


def test_observations_are_those_of_the_wrapper() -> None:
    bare, wrapped = made(), made(Halved)
    for envs in (bare, wrapped):
        envs.seed(1)
    assert same(wrapped.reset(), (0.5 * bare.reset()).astype(np.float32))
    for actions in actions_for(20):
        expected, result = bare.step(actions), wrapped.step(actions)
        assert same(result[0], 0.5 * expected[0])
        for info, bare_info in zip(result[3], expected[3], strict=True):
            if info:
                assert same(info.pop("terminal_observation"), 0.5 * bare_info.pop("terminal_observation"))
                assert same(info, bare_info)


def test_several_wrappers_act_together() -> None:
    envs = made(
        partial(wrappers.RescaleAction, min_action=np.float32(-2.0), max_action=np.float32(2.0)),
        partial(wrappers.TransformReward, func=doubled),
        wrappers.NormalizeReward,
        wrappers.RecordEpisodeStatistics,
    )
    bare = made()
    for actions in actions_for(10):
        expected, result = bare.step(actions), envs.step(2.0 * actions)
        np.testing.assert_allclose(result[0], expected[0], rtol=1e-4, atol=1e-5)
        assert same(result[2], expected[2])
        assert [info["TimeLimit.truncated"] for info in result[3] if info] == [
            info["TimeLimit.truncated"] for info in expected[3] if info
        ]
    assert envs.env_is_wrapped(wrappers.NormalizeReward) == [True] * COUNT
    assert envs.env_is_wrapped(wrappers.NormalizeReward, indices=[0]) == [True]
    assert envs.env_is_wrapped(Monitor) == [False] * COUNT


def test_seeds_options_and_attributes_reach_the_environments() -> None:
    bare, wrapped = made(), made(wrappers.RecordEpisodeStatistics, wrappers.NormalizeReward)
    for envs in (bare, wrapped):
        envs.set_options([{"position": (1.0, 0.0, 5.0)}, {}, {"current": (0.1, 0.0, 0.0)}])
        envs.seed(7)
    assert same(wrapped.reset(), bare.reset())
    assert same(wrapped.reset_infos, bare.reset_infos)
    for envs in (bare, wrapped):
        envs.set_attr("start_radius", 0.0, indices=[1])
        envs.seed(8)
    assert same(wrapped.reset(), bare.reset())
    assert wrapped.get_attr("start_radius") == [2.0, 0.0, 2.0]
    state = wrapped.env_method("get_state", indices=0)[0]
    for envs in (bare, wrapped):
        envs.env_method("set_state", state, indices=[2])
    assert same(wrapped.step(actions_for(1)[0])[0], bare.step(actions_for(1)[0])[0])


def test_closing_closes_all() -> None:
    envs = made(wrappers.RecordEpisodeStatistics)
    envs.close()
    assert envs.marine.closed


@pytest.mark.parametrize(
    ("wrap", "message"),
    [
        (Shifted, r"Shifted cannot act.*VecEnvWrapper of its own around MarineVecEnv, such as VecNormalize"),
        (wrappers.DictInfoToList, r"DictInfoToList cannot act.*leave the wrapper out"),
        (Foreign, r"Foreign is not a gymnasium\.vector\.VectorWrapper.*derive it from VectorWrapper"),
        (ToTensors, r"ToTensors cannot act.*NumPy arrays.*leave the wrapper out"),
        (
            lambda envs: wrappers.RecordEpisodeStatistics(wrappers.DictInfoToList(envs)),
            "DictInfoToList cannot act",
        ),
    ],
)
def test_wrappers_that_cannot_act_are_refused(wrap: Wrap, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        MarineVecEnv(wrap(plain()))


def test_a_wrapper_may_not_end_or_prolong_episodes() -> None:
    with pytest.raises(
        InvalidInputError, match=r"environment 1 has ended, but it goes on.*max_episode_steps"
    ):
        made(Ending, max_episode_steps=300).step(np.zeros((COUNT, 6)))
    envs = made(Prolonging, max_episode_steps=1)
    with pytest.raises(InvalidInputError, match=r"environment 0 goes on, but it has ended"):
        envs.step(np.zeros((COUNT, 6)))


def test_a_wrapper_that_forgets_the_last_observation_is_refused() -> None:
    envs = made(First, max_episode_steps=1)
    assert envs.observation_space.shape == (3,)
    with pytest.raises(
        InvalidInputError, match=r"shape \(3,\), but not infos\['final_obs'\], of shape \(18,\)"
    ):
        envs.step(np.zeros((COUNT, 6)))
