"""The environments of Stable-Baselines3: what its own `DummyVecEnv` of single environments does, to the last bit."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv
from support.environments import StationKeepingEnv
from support.equivalence import same
from support.sb3_envs import actions_for, assert_same_step, dummy, marine
from support.vector_envs import BUSY

from dq_marine.agents.training.vec_env import MarineVecEnv
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"


BOTH = [marine, dummy]


def both(count: int, seed: int | None = 0, **keywords: Any) -> tuple[VecEnv, VecEnv]:
    """Return ours and Stable-Baselines3's, reset."""
    made = marine(count, **keywords), dummy(count, **keywords)
    for envs in made:
        if seed is not None:
            envs.seed(seed)
        envs.reset()
    return made


# Stepping


@pytest.mark.parametrize("count", [1, 3, 8, 13])
def test_everything_returned_is_what_dummy_vec_env_returns(count: int) -> None:
    ours, theirs = marine(count, **BUSY), dummy(count, **BUSY)
    for envs in (ours, theirs):
        envs.seed(5)
    assert same(ours.reset(), theirs.reset())
    assert same(ours.reset_infos, theirs.reset_infos)
    ends = limits = 0
    for period, actions in enumerate(actions_for(count, 200, scale=1.5)):
        result, expected = ours.step(actions), theirs.step(actions)
        assert_same_step(result, expected)
        assert same(ours.reset_infos, theirs.reset_infos)
        ends += expected[2].sum()
        limits += sum(info["TimeLimit.truncated"] for info in expected[3])
        if period == 100:
            assert same(ours.reset(), theirs.reset())
            assert same(ours.reset_infos, theirs.reset_infos)
    assert (result[0].dtype, result[1].dtype, result[2].dtype) == (np.float32, np.float32, bool)
    assert ends > 20 * count
    assert 0 < limits < ends or count == 1


def test_an_end_says_what_stable_baselines_asks_for() -> None:
    envs = marine(3, max_episode_steps=2)
    envs.seed(0)
    envs.reset()
    single = StationKeepingEnv()
    single.reset(seed=1)
    first, second = actions_for(3, 2)
    *_, infos = envs.step(first)
    single.step(first[1])
    assert not any("terminal_observation" in info for info in infos)
    assert not any(info.get("TimeLimit.truncated", False) for info in infos)
    observations, rewards, dones, infos = envs.step(second)
    observation, reward, *_, info = single.step(second[1])
    assert dones.all()
    assert rewards[1] == np.float32(reward)
    assert same(infos[1], info | {"terminal_observation": observation, "TimeLimit.truncated": True})
    assert same(observations[1], single.reset()[0])


def test_leaving_the_workspace_at_the_limit_is_not_a_time_limit() -> None:
    """So that a learner does not bootstrap from beyond the edge."""
    envs = marine(2, max_episode_steps=1, workspace_radius=3.0)
    leaving = {"position": (2.95, 0.0, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0)}
    envs.set_options([leaving | {"velocity": (sign * 1.5, 0, 0, 0, 0, 0)} for sign in (1, -1)])
    envs.reset()
    _, _, dones, infos = envs.step(np.zeros((2, 6)))
    assert dones.all()
    assert [info["TimeLimit.truncated"] for info in infos] == [False, True]


def test_a_refused_step_ends_the_episode_and_says_why() -> None:
    keywords = {"substeps": 1, "control_period": 0.5, "workspace_radius": 1e4, "start_radius": 1.0}
    ours, theirs = marine(3, **keywords), dummy(3, **keywords)
    slow = {"velocity": (0.1,) * 6}
    fast = {"velocity": (3e4, 3e4, 0.0, 5e3, 8e4, 9e3), "position": (0.0, 0.0, 5.0)}
    for envs in (ours, theirs):
        envs.seed(0)
        envs.set_options([slow, fast, slow])
        envs.reset()
    reasons = []
    for _ in range(10):
        result, expected = ours.step(np.zeros((3, 6))), theirs.step(np.zeros((3, 6)))
        assert_same_step(result, expected)
        reasons.append(any(info.get("refused", False) for info in result[3]))
    assert any(reasons)


def test_wrong_actions_are_refused_and_change_nothing() -> None:
    ours, twin = marine(3), marine(3)
    with pytest.raises(ResetNeeded, match="reset"):
        ours.step(np.zeros((3, 6)))
    for envs in (ours, twin):
        envs.seed(0)
        envs.reset()
    nan = np.zeros((3, 6))
    nan[2, 0] = np.nan
    for wrong, message in ((np.zeros((2, 6)), "action"), (np.zeros(18), "action"), (nan, r"action.*\b2\b")):
        with pytest.raises(InvalidInputError, match=message):
            ours.step(wrong)
    for actions in actions_for(3, 3):
        assert same(ours.step(actions), twin.step(actions))


def test_what_is_returned_is_the_callers_own() -> None:
    """Learners add to rewards, wrappers write into infos."""
    ours, theirs = both(3, **BUSY)
    for actions in actions_for(3, 30):
        result, expected = ours.step(actions), theirs.step(actions)
        assert_same_step(result, expected)
        assert len({id(info) for info in result[3]}) == 3
        for info in result[3]:
            if "terminal_observation" in info:
                info["terminal_observation"][:] = 9.0
            info["written"] = True
        result[0][:] = 9.0
        result[1][:] += 1.0
        result[2][:] = True
        for info in ours.reset_infos:
            assert "written" not in info


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
def test_other_autoreset_modes_are_refused(mode: AutoresetMode) -> None:
    with pytest.raises(InvalidInputError, match=r"autoreset_mode.*(SameStep|SAME_STEP)"):
        MarineVecEnv(gym.make_vec(ID, num_envs=2, autoreset_mode=mode))


# Seeds and options


def test_seeds_count_up_and_are_used_once() -> None:
    ours, theirs = both(3, seed=None)
    for envs in (ours, theirs):
        assert envs.seed(7) == [7, 8, 9]
    assert same(ours.reset(), theirs.reset())
    for _ in range(2):
        assert same(ours.reset(), theirs.reset())
    first = ours.reset()
    ours.seed(7)
    assert not same(ours.reset(), first)


def test_seeding_without_a_number_draws_one() -> None:
    seeds = []
    for make in BOTH:
        np.random.seed(3)  # noqa: NPY002 - the generator that Stable-Baselines3 draws from
        envs = make(3)
        seeds.append(list(envs.seed()))
        observations = envs.reset()
        assert len(np.unique(observations, axis=0)) == 3
    assert seeds[0] == seeds[1]


def test_options_are_used_once_for_all_or_for_each() -> None:
    ours, theirs = both(3)
    for options in (
        {"position": (1.0, 0.0, 5.0)},
        [{"position": (1.0, 0.0, 5.0)}, {}, {"current": (0.1, 0.0, 0.0), "velocity": (0.1,) * 6}],
        [{"goal_position": (float(i), 0.0, 5.0)} for i in range(3)],
        None,
    ):
        for envs in (ours, theirs):
            envs.seed(4)
            envs.set_options(options)
        assert same(ours.reset(), theirs.reset())
        assert same(ours.reset_infos, theirs.reset_infos)
        assert same(ours.reset(), theirs.reset())
        assert same(ours.step(np.zeros((3, 6)))[0], theirs.step(np.zeros((3, 6)))[0])
    ours.set_options({"place": (0.0, 0.0, 0.0)})
    with pytest.raises(InvalidInputError, match="place"):
        ours.reset()


# Its environments


def test_it_presents_itself_as_dummy_vec_env_does() -> None:
    ours, theirs = both(3, workspace_radius=3.0)
    assert isinstance(ours, VecEnv)
    assert ours.unwrapped is ours
    assert ours.num_envs == 3
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert ours.render_mode is None
    assert ours.env_is_wrapped(Monitor) == [False, False, False]
    assert ours.env_is_wrapped(Monitor, indices=[0, 2]) == [False, False]
    assert ours.env_is_wrapped(Monitor, indices=1) == [False]
    for envs in (ours, theirs):
        with pytest.warns(UserWarning, match="rgb_array"):
            assert list(envs.get_images()) == [None, None, None]
        with pytest.warns(UserWarning, match="render_mode"):
            assert envs.render() is None


@pytest.mark.parametrize("indices", [None, 1, [0, 2], [-1], range(1, 3)])
def test_attributes_and_methods_of_chosen_environments(indices: Any) -> None:
    ours, theirs = both(3)
    for actions in actions_for(3, 5):
        ours.step(actions)
        theirs.step(actions)
    for name in ("position_ned", "time", "fallback_substeps", "control_period", "render_mode"):
        assert same(ours.get_attr(name, indices), theirs.get_attr(name, indices)), name
    assert same(
        ours.env_method("get_state", indices=indices), theirs.env_method("get_state", indices=indices)
    )
    for envs in (ours, theirs):
        envs.set_attr("label", 4)
        envs.set_attr("label", 5, indices=indices)
    assert ours.get_attr("label") == theirs.get_attr("label")
    state = ours.env_method("get_state", indices=1)[0]
    for envs in (ours, theirs):
        envs.env_method("set_state", state, indices=indices)
    assert_same_step(ours.step(actions), theirs.step(actions))


def test_which_attributes_there_are() -> None:
    ours, _ = both(2)
    assert ours.has_attr("position_ned")
    assert ours.has_attr("render_mode")
    assert not ours.has_attr("nonsense")
    with pytest.raises(AttributeError, match="nonsense"):
        ours.get_attr("nonsense")
    with pytest.raises(AttributeError, match="nonsense"):
        ours.env_method("nonsense")


def test_setting_an_attribute_acts_on_the_next_episodes() -> None:
    ours, _ = both(3)
    ours.set_attr("start_radius", 0.0, indices=[0, 2])
    assert ours.get_attr("start_radius") == [0.0, 2.0, 0.0]
    ours.seed(1)
    ours.reset()
    away = [info["position_error"] > 1e-9 for info in ours.reset_infos]
    assert away == [False, True, False]


def test_closing_closes_the_vector_environment() -> None:
    inner = gym.make_vec(ID, num_envs=2, autoreset_mode=AutoresetMode.SAME_STEP)
    envs = MarineVecEnv(inner)
    envs.reset()
    envs.close()
    assert inner.closed
    envs.close()


@pytest.mark.browser
def test_pictures_are_tiled() -> None:
    envs = marine(2, render_mode="rgb_array", current=0.0)
    assert envs.render_mode == "rgb_array"
    envs.seed(0)
    envs.reset()
    first, second = envs.get_images()
    assert first is not None
    assert first.dtype == np.uint8
    assert (first != second).any()
    tiled = envs.render()
    assert tiled is not None
    assert tiled.size == first.size + second.size  # type: ignore[union-attr]
    envs.close()
