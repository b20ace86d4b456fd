"""What follows an episode's end: the three autoreset modes, as Gymnasium's own vector environment has them."""

from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import vector as wrappers
from support.environments import StationKeepingEnv
from support.vector_envs import BUSY, reference, same

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"
NEXT_STEP, SAME_STEP, DISABLED = AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED


def compiled(count, mode=NEXT_STEP, **keywords):
    return gym.make_vec(ID, num_envs=count, autoreset_mode=mode, **keywords)


def actions_for(count, periods, scale=1.0):
    return np.random.default_rng(0).uniform(-scale, scale, (periods, count, 6)).astype(np.float32)


NAMES = {2: ("observations", "infos"), 5: ("observations", "rewards", "terminations", "truncations", "infos")}
"""What `reset` and `step` return."""


def assert_same(ours, theirs, when):
    for name, own, expected in zip(NAMES[len(theirs)], ours, theirs, strict=True):
        assert same(own, expected), f"{name} {when}: {own} instead of {expected}"


# Gymnasium's own, side by side


@pytest.mark.parametrize("mode", AutoresetMode)
@pytest.mark.parametrize(("count", "threads"), [(1, None), (3, 1), (8, 3), (13, 2), (20, None)])
def test_everything_returned_is_what_gymnasium_returns(mode, count, threads):
    ours, theirs = compiled(count, mode, threads=threads, **BUSY), reference(count, mode, **BUSY)
    assert_same(ours.reset(seed=3), theirs.reset(seed=3), "after reset")
    terminated, truncated, partial_ends = [], [], 0
    for period, actions in enumerate(actions_for(count, 250, scale=2.0)):
        expected = theirs.step(actions)
        assert_same(ours.step(actions), expected, f"in period {period}")
        terminated.append(expected[2])
        truncated.append(expected[3])
        ended = expected[2] | expected[3]
        partial_ends += ended.any() and not ended.all()
        if mode is DISABLED and ended.any():
            resets = [each.reset(options={"reset_mask": ended.copy()}) for each in (ours, theirs)]
            assert_same(*resets, f"after period {period}")
        if period in (100, 200):  # in the middle of episodes, without a seed
            assert_same(ours.reset(), theirs.reset(), f"reset after period {period}")
    terminated, truncated = np.concatenate(terminated), np.concatenate(truncated)
    if count > 1:
        assert partial_ends > 10
        assert (terminated & ~truncated).any()
        assert (truncated & ~terminated).any()
        assert (terminated & truncated).any() or count < 8


@pytest.mark.parametrize("mode", AutoresetMode)
def test_partial_resets_are_what_gymnasium_does(mode):
    """Masks in every mode: in the middle of episodes, between an end and its reset, with and without seeds."""
    count, random = 8, np.random.default_rng(1)
    ours, theirs = compiled(count, mode, **BUSY), reference(count, mode, **BUSY)
    for each in (ours, theirs):
        each.reset(seed=3)
    reset_while_ended = left_while_ended = 0
    for period, actions in enumerate(actions_for(count, 120)):
        expected = theirs.step(actions)
        assert_same(ours.step(actions), expected, f"in period {period}")
        ended = expected[2] | expected[3]
        mask = random.uniform(size=count) < 0.3
        if mode is DISABLED:
            mask |= ended
        if not mask.any():
            continue
        reset_while_ended += (ended & mask).sum()
        left_while_ended += (ended & ~mask).sum()
        seed = [None, 50 + period, [period * i if i % 3 else None for i in range(count)]][period % 3]
        resets = [each.reset(seed=seed, options={"reset_mask": mask.copy()}) for each in (ours, theirs)]
        assert_same(*resets, f"after period {period}")
    assert reset_while_ended > 10
    assert left_while_ended > 10 or mode is DISABLED


def test_the_time_limit_is_30_s_unless_given():
    for keywords, limit in (({}, 300), ({"max_episode_steps": 3}, 3)):
        envs = compiled(3, **keywords)
        still = {"position": (0.0, 0.0, 5.0), "quaternion": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 6}
        still["current"] = (0.0, 0.0, 0.0)
        envs.reset(seed=0, options=still)
        for period in range(1, limit + 1):
            _, _, terminated, truncated, _ = envs.step(np.zeros((3, 6)))
            assert not terminated.any()
            assert truncated.tolist() == [period == limit] * 3


# The modes, spelled out

EDGE = {
    "position": np.array([[2.95, 0.0, 5.0], [0.0, 0.0, 5.0], [2.95, 0.0, 5.0]]),
    "quaternion": (1.0, 0.0, 0.0, 0.0),
    "velocity": np.array([[1.5, 0, 0, 0, 0, 0], [0.0] * 6, [-1.5, 0, 0, 0, 0, 0]]),
    "current": (0.0, 0.0, 0.0),
}
"""Of three environments the first leaves a workspace of 3 m at once, the others do not."""


def singles_at_the_edge():
    singles = [StationKeepingEnv(workspace_radius=3.0) for _ in range(3)]
    for i, single in enumerate(singles):
        own = {key: value[i] if np.ndim(value) == 2 else value for key, value in EDGE.items()}
        single.reset(seed=i, options=own)
    return singles


def test_next_step_resets_in_the_step_after_the_end_whatever_the_action():
    envs, singles = compiled(3, workspace_radius=3.0), singles_at_the_edge()
    envs.reset(seed=0, options=EDGE)
    actions = actions_for(3, 3)
    last = [single.step(action) for single, action in zip(singles, actions[0], strict=True)]
    observations, rewards, terminations, truncations, infos = envs.step(actions[0])
    assert terminations.tolist() == [True, False, False]
    assert not truncations.any()
    assert same(observations[0], last[0][0])  # of the end, not of a new episode
    assert rewards[0] == last[0][1]
    assert infos["position_error"][0] > 3.0
    assert set(infos) == {f"{mask}{key}" for key in last[0][-1] for mask in ("", "_")}

    starts = [singles[0].reset(), *(singles[i].step(actions[1, i]) for i in (1, 2))]
    observations, rewards, terminations, truncations, infos = envs.step(actions[1])
    for i in range(3):
        assert same(observations[i], starts[i][0])
    assert rewards.tolist() == [0.0, starts[1][1], starts[2][1]]
    assert not terminations.any()
    assert not truncations.any()
    assert np.array_equal(infos["current_ned"], [start[-1]["current_ned"] for start in starts])
    assert infos["_position_error"].all()
    assert infos["position_error"][0] == starts[0][1]["position_error"]

    observation, reward, *_ = singles[0].step(actions[2, 0])
    observations, rewards, *_, infos = envs.step(actions[2])
    assert same(observations[0], observation)
    assert rewards[0] == reward


def test_same_step_returns_the_new_episode_and_keeps_the_end_in_the_infos():
    envs, singles = compiled(3, SAME_STEP, workspace_radius=3.0), singles_at_the_edge()
    envs.reset(seed=0, options=EDGE)
    actions = actions_for(3, 2)
    last = [single.step(action) for single, action in zip(singles, actions[0], strict=True)]
    start, start_info = singles[0].reset()
    observations, rewards, terminations, truncations, infos = envs.step(actions[0])
    assert terminations.tolist() == [True, False, False]
    assert not truncations.any()
    assert rewards.tolist() == [reward for _, reward, *_ in last]
    assert same(observations[0], start)
    assert same(observations[1], last[1][0])
    only_first = np.array([True, False, False])
    assert infos["final_obs"].dtype == object
    assert same(infos["final_obs"][0], last[0][0])
    assert infos["final_obs"][1:].tolist() == [None, None]
    for key in ("_final_obs", "_final_info"):
        assert same(infos[key], only_first), key
    final = infos["final_info"]
    for key in ("position_error", "attitude_error", "is_success"):
        assert final[key][0] == last[0][-1][key]
        assert final[key].dtype == (bool if key == "is_success" else np.float64)
        assert not final[key][1:].any()
        assert same(final[f"_{key}"], only_first)
        assert infos[key].tolist() == [start_info[key], last[1][-1][key], last[2][-1][key]]
        assert infos[f"_{key}"].all()
    assert np.array_equal(infos["current_ned"][0], start_info["current_ned"])

    observations, *_, infos = envs.step(actions[1])
    assert same(observations[0], singles[0].step(actions[1, 0])[0])
    assert not {"final_obs", "_final_obs", "final_info", "_final_info"} & set(infos)


def test_disabled_refuses_to_step_an_ended_episode_until_it_is_reset():
    envs, singles = compiled(3, DISABLED, workspace_radius=3.0), singles_at_the_edge()
    envs.reset(seed=0, options=EDGE)
    actions = actions_for(3, 2)
    last = [single.step(action) for single, action in zip(singles, actions[0], strict=True)]
    observations, _, terminations, _, _ = envs.step(actions[0])
    assert same(list(observations), [observation for observation, *_ in last])
    assert terminations.tolist() == [True, False, False]
    before = envs.call("get_state")
    for _ in range(2):
        with pytest.raises(Exception, match=r"\b0\b.*reset|reset.*\b0\b"):
            envs.step(actions[1])
        assert same(envs.call("get_state"), before)
    observations, infos = envs.reset(options={"reset_mask": terminations})
    start, start_info = singles[0].reset()
    assert same(list(observations), [start, last[1][0], last[2][0]])
    assert infos["_position_error"].tolist() == [True, False, False]
    assert infos["position_error"][0] == start_info["position_error"]
    observations, *_ = envs.step(actions[1])
    for i, single in enumerate(singles):
        assert same(observations[i], single.step(actions[1, i])[0])


@pytest.mark.parametrize("mode", AutoresetMode)
def test_a_mode_may_be_given_by_its_value(mode):
    envs, twin = compiled(3, mode.value, max_episode_steps=2), compiled(3, mode, max_episode_steps=2)
    assert envs.metadata["autoreset_mode"] is mode
    for each in (envs, twin):
        each.reset(seed=0)
    for actions in actions_for(3, 2 if mode is DISABLED else 5):
        assert same(envs.step(actions), twin.step(actions))


class Nameless:
    """An object that cannot be printed."""

    def __repr__(self):
        raise RuntimeError("no repr")


@pytest.mark.parametrize("mode", [Nameless(), None, 3, "sometimes", b"Disabled"], ids=range(5))
def test_what_is_no_mode_is_refused(mode):
    with pytest.raises(InvalidInputError, match=r"autoreset_mode = .*unknown; give one of"):
        compiled(3, mode)


# Gymnasium's wrappers

WRAPPERS = {
    "DictInfoToList": wrappers.DictInfoToList,
    "NormalizeObservation": wrappers.NormalizeObservation,
    "NormalizeReward": wrappers.NormalizeReward,
    "ClipReward": partial(wrappers.ClipReward, min_reward=0.0, max_reward=0.3),
    "ClipAction": wrappers.ClipAction,
    "RescaleAction": partial(wrappers.RescaleAction, min_action=np.float32(-3.0), max_action=np.float32(3.0)),
}


@pytest.mark.parametrize("name", WRAPPERS)
def test_gymnasiums_wrappers_see_no_difference(name):
    wrap = WRAPPERS[name]
    envs, gymnasiums = (wrap(made) for made in (compiled(3, **BUSY), reference(3, **BUSY)))
    assert same(envs.reset(seed=0), gymnasiums.reset(seed=0))
    for actions in np.random.default_rng(0).uniform(-3.0, 3.0, (40, 3, 6)).astype(np.float32):
        assert same(envs.step(actions), gymnasiums.step(actions))


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_episode_statistics_are_counted_alike(mode):
    made = compiled(3, mode, **BUSY), reference(3, mode, **BUSY)
    envs, gymnasiums = map(wrappers.RecordEpisodeStatistics, made)
    for each in (envs, gymnasiums):
        each.reset(seed=0)
    for actions in actions_for(3, 60):
        infos, expected = (each.step(actions)[-1] for each in (envs, gymnasiums))
        for info in (infos, expected):
            info.get("episode", {}).pop("t", None)
        assert same(infos, expected)
    assert envs.episode_count > 10
    assert envs.return_queue == gymnasiums.return_queue


def test_episode_statistics_see_the_mask_of_a_partial_reset():
    """The wrapper reads the mask after the environment has, from the caller's own options."""
    envs = wrappers.RecordEpisodeStatistics(compiled(3))
    envs.reset(seed=0)
    for actions in actions_for(3, 4):
        envs.step(actions)
    envs.reset(options={"reset_mask": np.array([False, True, False])})
    assert envs.episode_lengths.tolist() == [4, 0, 4]


def test_an_episode_that_was_restored_goes_on_where_another_had_ended():
    """It is not taken for the ended one, which the next step would renew."""
    envs = compiled(3, max_episode_steps=4)
    envs.reset(seed=0)
    actions = actions_for(3, 12)
    envs.step(actions[0])
    state = envs.unwrapped.call("get_state")[1]
    flight = [envs.step(one)[0][1] for one in actions[1:3]]
    *_, truncated, _ = envs.step(actions[3])
    assert truncated.all()
    envs.unwrapped.call_at(1, "set_state", state)
    assert [envs.step(one)[0][1].tolist() for one in actions[1:3]] == [one.tolist() for one in flight]
