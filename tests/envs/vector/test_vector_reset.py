"""Resetting the vector environment: seeds, options for all or row by row, masks, and what is refused."""

import copy

import gymnasium as gym
import numpy as np
import pytest
from support.environments import StationKeepingEnv
from support.vector_envs import reference, same, states

import dq_marine  # noqa: F401 - registers
from dq_marine.errors import InvalidInputError

ID = "dq_marine/StationKeeping-v0"


def actions_for(envs, periods):
    shape = (periods, *envs.action_space.shape)
    return np.random.default_rng(0).uniform(-1.0, 1.0, shape).astype(np.float32)


def test_seeds_count_up_or_are_listed():
    envs, gymnasiums = gym.make_vec(ID, num_envs=3), reference(3)
    for seed in (5, None, [9, 2, 2**70], [None, 4, None], 2**31, None):
        assert same(envs.reset(seed=seed), gymnasiums.reset(seed=seed))
        assert envs.get_attr("np_random_seed") == gymnasiums.get_attr("np_random_seed")
    generators = envs.get_attr("np_random")
    assert all(isinstance(generator, np.random.Generator) for generator in generators)
    expected = [generator.bit_generator.state for generator in gymnasiums.get_attr("np_random")]
    assert [generator.bit_generator.state for generator in generators] == expected


def test_without_a_seed_every_episode_is_new():
    """Told by poses and currents: one start in ten is at rest at the goal, where observations are all the same."""
    drawn = []
    for _ in range(2):
        envs = gym.make_vec(ID, num_envs=3)
        envs.reset()
        drawn += [np.concatenate([state["state"], state["report"][-3:]]) for state in states(envs)]
    assert len(np.unique(drawn, axis=0)) == 6


@pytest.mark.parametrize("seed", [[1, 2], [1, 2, 3, 4], [1, -1, 3], -5])
def test_wrong_seeds_are_refused_and_the_episodes_go_on(seed):
    envs = gym.make_vec(ID, num_envs=3)
    envs.reset(seed=0)
    before = states(envs)
    with pytest.raises((ValueError, gym.error.Error)):
        envs.reset(seed=seed)
    assert same(states(envs), before)


ROWS = {
    "position": np.array([[1.0, 0.0, 5.0], [0.0, 1.5, 4.0], [-1.0, 0.5, 5.5]]),
    "quaternion": np.array([[1.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.8], [0.5, 0.5, 0.5, 0.5]]),
    "velocity": np.linspace(-0.3, 0.4, 18).reshape(3, 6),
    "current": np.array([[0.1, 0.0, 0.0], [0.0, -0.2, 0.0], [0.05, 0.1, 0.02]]),
    "goal_position": np.array([[0.0, 0.0, 5.0], [0.5, 0.0, 5.0], [0.0, 0.5, 4.0]]),
    "goal_quaternion": np.array([[1.0, 0.0, 0.0, 0.0], [0.8, 0.0, 0.6, 0.0], [0.0, 0.0, 0.0, 1.0]]),
}


@pytest.mark.parametrize("keys", [*[[key] for key in ROWS], list(ROWS)])
def test_options_hold_for_all_or_row_by_row(keys):
    """Each key once with a row for every environment, while the others that are given hold for all."""
    envs, single = gym.make_vec(ID, num_envs=3), StationKeepingEnv()
    for by_row in ([], *[[key] for key in keys], keys):
        options = {key: ROWS[key] if key in by_row else ROWS[key][1].tolist() for key in keys}
        observations, infos = envs.reset(seed=11, options=options)
        for i in range(3):
            own = {key: ROWS[key][i] if key in by_row else ROWS[key][1] for key in keys}
            observation, info = single.reset(seed=11 + i, options=own)
            assert same(observations[i], observation)
            assert infos["position_error"][i] == info["position_error"]
            assert infos["attitude_error"][i] == info["attitude_error"]
            assert np.array_equal(infos["current_ned"][i], info["current_ned"])
            assert same(states(envs)[i], single.get_state())


def test_the_callers_options_are_not_changed(envs):
    positions = np.tile([0.5, 0.0, 5.0], (8, 1))
    options = {"position": positions, "reset_mask": np.arange(8) < 3}
    before = copy.deepcopy(options)
    envs.reset(seed=1, options=options)
    assert same(options, before)
    after = states(envs)
    positions[:] = 7.0  # nor are they kept
    options["reset_mask"][:] = True
    assert same(states(envs), after)


def test_a_mask_resets_only_its_environments(envs):
    """In the default mode, with the episodes of the others going on undisturbed."""
    mask = np.array([True, False, False, True, False, True, False, False])
    actions = actions_for(envs, 10)
    twin = reference(8)
    for each in (envs, twin):
        each.reset(seed=0)
    for action in actions[:5]:
        observed = envs.step(action)[0]
        twin.step(action)
    observations, infos = envs.reset(seed=40, options={"position": (0.3, 0.2, 5.1), "reset_mask": mask})
    assert same(observations[~mask], observed[~mask])
    expected = twin.reset(seed=40, options={"position": (0.3, 0.2, 5.1), "reset_mask": mask})
    assert same((observations, infos), expected)
    assert np.array_equal(infos["_current_ned"], mask)
    for action in actions[5:]:
        assert same(envs.step(action), twin.step(action))


def test_rows_go_with_a_mask():
    """There is a row for every environment, read where the mask is set."""
    envs, single = gym.make_vec(ID, num_envs=3), StationKeepingEnv()
    envs.reset(seed=0)
    before = states(envs)
    mask = np.array([False, True, True])
    _, infos = envs.reset(seed=20, options=ROWS | {"reset_mask": mask})
    assert same(states(envs)[0], before[0])
    for i in (1, 2):
        _, info = single.reset(seed=20 + i, options={key: rows[i] for key, rows in ROWS.items()})
        assert infos["position_error"][i] == info["position_error"]
        assert same(states(envs)[i], single.get_state())
    assert same(infos["_position_error"], mask)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"place": (0, 0, 0)}, r"place.*position"),
        ({"position": (0.0, 0.0)}, "position"),
        ({"position": np.zeros((7, 3))}, "position"),
        ({"position": np.zeros((8, 2))}, "position"),
        ({"position": np.zeros((3, 8))}, "position"),
        ({"position": np.zeros((1, 8, 3))}, "position"),
        ({"position": [[1.0, 2.0, 3.0], [1.0]]}, "position"),
        ({"velocity": "fast"}, "velocity"),
        ({"velocity": np.where(np.arange(8)[:, None] == 6, np.nan, np.zeros((8, 6)))}, "velocity"),
        ({"quaternion": np.tile([1.0, 1.0, 0.0, 0.0], (8, 1))}, "quaternion"),
        ({"goal_quaternion": (1.0, 0.1, 0.0, 0.0)}, "goal_quaternion"),
        ({"reset_mask": np.ones(7, dtype=bool)}, "reset_mask"),
        ({"reset_mask": np.ones((8, 1), dtype=bool)}, "reset_mask"),
        ({"reset_mask": np.arange(8)}, "reset_mask"),
        ({"reset_mask": np.zeros(8, dtype=bool)}, "reset_mask"),
    ],
)
def test_wrong_options_are_refused_and_the_episodes_go_on(envs, options, message):
    envs.step(actions_for(envs, 1)[0])
    before = states(envs)
    with pytest.raises(InvalidInputError, match=message):
        envs.reset(options=options)
    assert same(states(envs), before)


def test_a_current_option_needs_a_current():
    envs = gym.make_vec(ID, num_envs=2, current=0.0)
    envs.reset(options={"current": np.zeros((2, 3))})
    with pytest.raises(InvalidInputError, match="without a current"):
        envs.reset(options={"current": np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]])})
